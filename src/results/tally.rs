//! Counts over many runs.

use serde::{Deserialize, Serialize};

use super::RunResult;
use crate::scene::Outcome;

/// The outcome of one of many runs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum Ending {
    /// The run reached its end.
    Completed,
    /// The run reached its time limit.
    Timeout,
    /// The run failed.
    Failed,
    /// The simulation cannot be trusted.
    Diverged,
    /// The process of the run crashed.
    Crashed,
    /// The run could not begin.
    Refused,
}

impl Ending {
    /// The name in results and tables.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Completed => "completed",
            Self::Timeout => "timeout",
            Self::Failed => "failed",
            Self::Diverged => "diverged",
            Self::Crashed => "crashed",
            Self::Refused => "refused",
        }
    }
}

impl From<Outcome> for Ending {
    fn from(outcome: Outcome) -> Self {
        match outcome {
            Outcome::Completed => Self::Completed,
            Outcome::Timeout => Self::Timeout,
            Outcome::Failed => Self::Failed,
            Outcome::Diverged => Self::Diverged,
            Outcome::Refused => Self::Refused,
        }
    }
}

/// The figures of a run that are counted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Figures {
    /// The outcome.
    pub ending: Ending,
    /// True if all expectations of its scenario hold.
    pub passed: bool,
    /// True if the body touched something.
    pub collided: bool,
    /// Mean of its errors (mm).
    pub error_mean_mm: Option<f64>,
    /// 95th percentile of its errors (mm).
    pub error_p95_mm: Option<f64>,
    /// The counts of its tips.
    pub tips: TipShares,
}

/// The number of tips of some runs, of outliers, and of tips within their 95 % interval.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct TipShares {
    /// Number of tips.
    pub count: f64,
    /// Number of outliers.
    pub outliers: f64,
    /// Number of tips within the 95 % interval that they report.
    pub within_band: f64,
}

impl TipShares {
    /// The counts of one run, by its shares (0 to 1) of `count` tips.
    #[must_use]
    pub(crate) fn of_run(count: usize, outliers: Option<f64>, within_band: Option<f64>) -> Self {
        let count = count as f64;
        Self { count, outliers: count * outliers.unwrap_or(0.0), within_band: count * within_band.unwrap_or(0.0) }
    }

    /// Share of outliers among all tips, 0 to 1. `None` without a tip.
    #[must_use]
    pub(crate) fn outlier_share(&self) -> Option<f64> {
        (self.count > 0.0).then(|| self.outliers / self.count)
    }

    /// Share of tips within the 95 % interval that they report, 0 to 1. `None` without a tip.
    #[must_use]
    pub(crate) fn within_band_share(&self) -> Option<f64> {
        (self.count > 0.0).then(|| self.within_band / self.count)
    }
}

impl std::iter::Sum for TipShares {
    fn sum<I: Iterator<Item = Self>>(runs: I) -> Self {
        runs.fold(Self::default(), |sum, run| Self {
            count: sum.count + run.count,
            outliers: sum.outliers + run.outliers,
            within_band: sum.within_band + run.within_band,
        })
    }
}

impl Figures {
    /// The figures of a run. `passed` is true if its expectations hold.
    #[must_use]
    pub fn new(result: &RunResult, passed: bool) -> Self {
        Self {
            ending: result.outcome.into(),
            passed,
            collided: result.collisions.count > 0,
            error_mean_mm: result.error_mm.mean,
            error_p95_mm: result.error_mm.p95,
            tips: TipShares::of_run(result.error_mm.n, result.error_mm.outliers, result.error_mm.within_band),
        }
    }
}

/// Counts and mean errors over some runs.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Tally {
    /// Number of runs.
    pub runs: usize,
    /// Number of completed runs.
    pub completed: usize,
    /// Number of completed runs whose expectations hold. Families expect that the object is traced and that the body
    /// touches nothing.
    pub passed: usize,
    /// Number of timeouts.
    pub timeout: usize,
    /// Number of failed runs.
    pub failed: usize,
    /// Number of diverged runs.
    pub diverged: usize,
    /// Number of runs whose process crashed.
    pub crashed: usize,
    /// Number of runs that could not begin.
    pub refused: usize,
    /// Number of runs in which the body touched something.
    pub collided: usize,
    /// Mean of the mean errors of the completed runs (mm).
    pub error_mean_mm: Option<f64>,
    /// Mean of the 95th percentiles of the errors of the completed runs (mm).
    pub error_p95_mm: Option<f64>,
    /// Share of outliers among the tips of all runs, 0 to 1.
    pub outliers: Option<f64>,
    /// Share of tips of all runs within the 95 % interval that they report, 0 to 1.
    pub within_band: Option<f64>,
}

impl Tally {
    /// Counts some runs.
    #[must_use]
    pub fn new(runs: impl IntoIterator<Item = Figures>) -> Self {
        let runs: Vec<_> = runs.into_iter().collect();
        let count = |counts: &dyn Fn(&Figures) -> bool| runs.iter().filter(|run| counts(run)).count();
        let ended = |ending| count(&|run| run.ending == ending);
        let tips: TipShares = runs.iter().map(|run| run.tips).sum();
        let completed = || runs.iter().filter(|run| run.ending == Ending::Completed);
        Self {
            runs: runs.len(),
            completed: ended(Ending::Completed),
            passed: count(&|run| run.passed),
            timeout: ended(Ending::Timeout),
            failed: ended(Ending::Failed),
            diverged: ended(Ending::Diverged),
            crashed: ended(Ending::Crashed),
            refused: ended(Ending::Refused),
            collided: count(&|run| run.collided),
            error_mean_mm: mean(completed().filter_map(|run| run.error_mean_mm)),
            error_p95_mm: mean(completed().filter_map(|run| run.error_p95_mm)),
            outliers: tips.outlier_share(),
            within_band: tips.within_band_share(),
        }
    }
}

fn mean(figures: impl Iterator<Item = f64>) -> Option<f64> {
    let figures: Vec<f64> = figures.collect();
    (!figures.is_empty()).then(|| figures.iter().sum::<f64>() / figures.len() as f64)
}
