//! What became of many runs.

use serde::{Deserialize, Serialize};

use super::RunResult;
use crate::scene::Outcome;

/// How a run of many ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum Ending {
    /// As it should.
    Completed,
    /// It was not there in time.
    Timeout,
    /// It failed.
    Failed,
    /// It can no longer be trusted.
    Diverged,
    /// It ended the process that it ran in.
    Crashed,
    /// It could not begin.
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
        }
    }
}

/// What is counted of a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Figures {
    /// How it ended.
    pub ending: Ending,
    /// Whether it was as its scenario expects.
    pub passed: bool,
    /// Whether the body touched something.
    pub collided: bool,
    /// Mean of its errors (mm).
    pub error_mean_mm: Option<f64>,
    /// Their 95th percentile (mm).
    pub error_p95_mm: Option<f64>,
    /// The shares of its tips that are counted.
    pub tips: TipShares,
}

/// How many tips some runs recorded, and how many of them lie where they should not or should.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct TipShares {
    /// How many tips there are.
    pub count: f64,
    /// How many of them are outliers.
    pub outliers: f64,
    /// How many lie within the 95 % interval that they report.
    pub within_band: f64,
}

impl TipShares {
    /// Those of one run, by its shares (0 to 1) of `count` tips.
    #[must_use]
    pub fn of_run(count: usize, outliers: Option<f64>, within_band: Option<f64>) -> Self {
        let count = count as f64;
        Self { count, outliers: count * outliers.unwrap_or(0.0), within_band: count * within_band.unwrap_or(0.0) }
    }

    /// Share of all tips that are outliers, 0 to 1; `None` without a tip.
    #[must_use]
    pub fn outlier_share(&self) -> Option<f64> {
        (self.count > 0.0).then(|| self.outliers / self.count)
    }

    /// Share of all tips that lie within the 95 % interval that they report, 0 to 1; `None` without a tip.
    #[must_use]
    pub fn within_band_share(&self) -> Option<f64> {
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
    /// Those of a run that took place, and `passed` or not.
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

/// What became of some runs.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Tally {
    /// How many runs there were.
    pub runs: usize,
    /// How many completed.
    pub completed: usize,
    /// How many completed as their scenarios expect. Families expect that the object is traced and that the body touches nothing.
    pub passed: usize,
    /// How many were not there in time.
    pub timeout: usize,
    /// How many failed.
    pub failed: usize,
    /// How many can no longer be trusted.
    pub diverged: usize,
    /// How many ended the process that they ran in.
    pub crashed: usize,
    /// How many could not begin.
    pub refused: usize,
    /// In how many the body touched something.
    pub collided: usize,
    /// Mean of the runs' mean errors, those that completed (mm).
    pub error_mean_mm: Option<f64>,
    /// Mean of their 95th percentiles (mm).
    pub error_p95_mm: Option<f64>,
    /// Share of the tips of all runs that are outliers, 0 to 1.
    pub outliers: Option<f64>,
    /// Share of the tips of all runs that lie within the 95 % interval that they report, 0 to 1.
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
