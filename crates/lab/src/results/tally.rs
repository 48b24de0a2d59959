//! Counts over many runs.

use serde::Serialize;

use super::{Ending, Rate, RunResult};
use crate::score::Statistics;
use vibrissa_declare::figures::Metric;

/// The figures of a run that are counted.
#[derive(Debug, Clone, Copy, PartialEq)]
#[expect(clippy::struct_excessive_bools, reason = "each is counted by itself")]
pub struct Figures {
    /// The outcome.
    pub ending: Ending,
    /// True if all expectations of its scenario hold.
    pub passed: bool,
    /// True if all of them hold but for a bound of the largest error.
    pub passed_but_for_tips: bool,
    /// True if the body touched something.
    pub collided: bool,
    /// True if a whisker slipped over or under an object.
    pub slipped: bool,
    /// The share of the exact contour that was traced, 0 to 1.
    pub coverage: Option<f64>,
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
    /// The counts of one run, by its figures.
    #[must_use]
    pub(crate) fn of_figures(figure: impl Fn(Metric) -> Option<f64>) -> Self {
        let count = figure(Metric::Tips).unwrap_or(0.0);
        Self::of_run(count, figure(Metric::Outliers), figure(Metric::IntervalCoverage))
    }

    /// The counts of one run, by its shares (0 to 1) of `count` tips.
    #[must_use]
    pub(crate) fn of_run(count: f64, outliers: Option<f64>, within_band: Option<f64>) -> Self {
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
    /// The figures of a run that does not pass, by its figures in the units of their keys.
    pub(crate) fn of(ending: Ending, figure: impl Fn(Metric) -> Option<f64>) -> Self {
        Self {
            ending,
            passed: false,
            passed_but_for_tips: false,
            collided: figure(Metric::Collisions).is_some_and(|count| count > 0.0),
            slipped: figure(Metric::Slips).is_some_and(|count| count > 0.0),
            coverage: figure(Metric::Coverage),
            error_mean_mm: figure(Metric::ErrorMean),
            error_p95_mm: figure(Metric::ErrorP95),
            tips: TipShares::of_figures(figure),
        }
    }

    /// The figures of a run.
    #[must_use]
    pub fn new(result: &RunResult) -> Self {
        Self {
            passed: result.violations.is_empty(),
            passed_but_for_tips: result.passed_but_for_tips,
            ..Self::of(result.outcome, |metric| result.figure(metric))
        }
    }
}

/// Counts, rates and mean errors over some runs.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Tally {
    /// Number of runs.
    pub runs: usize,
    /// Number of runs that met their stop condition, whether or not their expectations hold.
    pub completed: usize,
    /// Number of runs whose expectations hold. Families expect that the object is traced, that the body touches nothing,
    /// and that no recorded tip is more than 2 mm off.
    pub passed: usize,
    /// Number of runs whose expectations hold but for a bound of the largest error.
    pub passed_but_for_tips: usize,
    /// Number of runs that met their stop condition, but not all expectations.
    pub ended: usize,
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
    /// Number of runs that took place and in which the body touched nothing.
    pub collision_free: usize,
    /// Number of runs in which a whisker slipped over or under an object. Planar whiskers cannot.
    pub slipped: usize,
    /// The rates behind some of these numbers. `None` without runs.
    pub rates: Option<Rates>,
    /// Mean of the coverages of the completed runs, 0 to 1.
    pub coverage: Option<f64>,
    /// Mean of the mean errors of the completed runs (mm).
    pub error_mean_mm: Option<f64>,
    /// The 95 % interval of that mean. `None` with fewer than two completed runs.
    pub error_mean_interval_mm: Option<[f64; 2]>,
    /// Mean of the 95th percentiles of the errors of the completed runs (mm).
    pub error_p95_mm: Option<f64>,
    /// Share of outliers among the tips of all runs, 0 to 1.
    pub outliers: Option<f64>,
    /// Share of tips of all runs within the 95 % interval that they report, 0 to 1.
    pub within_band: Option<f64>,
}

/// Rates with their 95 % intervals.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Rates {
    /// Rate of runs that [pass](Tally::passed).
    pub passed: Rate,
    /// Rate of runs that pass [but for a tip](Tally::passed_but_for_tips).
    pub passed_but_for_tips: Rate,
    /// Rate of [completed](Tally::completed) runs.
    pub completed: Rate,
    /// Rate of [collision-free](Tally::collision_free) runs.
    pub collision_free: Rate,
}

impl Tally {
    /// Counts some runs.
    #[must_use]
    pub fn new(runs: impl IntoIterator<Item = Figures>) -> Self {
        let runs: Vec<_> = runs.into_iter().collect();
        let count = |counts: &dyn Fn(&Figures) -> bool| runs.iter().filter(|run| counts(run)).count();
        let ended = |ending| count(&|run| run.ending == ending);
        let tips: TipShares = runs.iter().map(|run| run.tips).sum();
        let completed = || runs.iter().filter(|run| run.ending.met_its_stop());
        let tally = Self {
            runs: runs.len(),
            completed: completed().count(),
            passed: count(&|run| run.passed),
            passed_but_for_tips: count(&|run| run.passed_but_for_tips),
            ended: ended(Ending::Ended),
            timeout: ended(Ending::Timeout),
            failed: ended(Ending::Failed),
            diverged: ended(Ending::Diverged),
            crashed: ended(Ending::Crashed),
            refused: ended(Ending::Refused),
            collided: count(&|run| run.collided),
            collision_free: count(&|run| !run.collided && run.ending.took_place()),
            slipped: count(&|run| run.slipped),
            rates: None,
            coverage: mean(completed().filter_map(|run| run.coverage)),
            error_mean_mm: mean(completed().filter_map(|run| run.error_mean_mm)),
            error_mean_interval_mm: Statistics::of(completed().filter_map(|run| run.error_mean_mm).collect())
                .and_then(|errors| errors.mean_interval()),
            error_p95_mm: mean(completed().filter_map(|run| run.error_p95_mm)),
            outliers: tips.outlier_share(),
            within_band: tips.within_band_share(),
        };
        Self { rates: Rates::of(&tally), ..tally }
    }
}

impl Rates {
    fn of(tally: &Tally) -> Option<Self> {
        let rate = |count| Rate::new(count, tally.runs);
        Some(Self {
            passed: rate(tally.passed)?,
            passed_but_for_tips: rate(tally.passed_but_for_tips)?,
            completed: rate(tally.completed)?,
            collision_free: rate(tally.collision_free)?,
        })
    }
}

fn mean(figures: impl Iterator<Item = f64>) -> Option<f64> {
    let figures: Vec<f64> = figures.collect();
    (!figures.is_empty()).then(|| figures.iter().sum::<f64>() / figures.len() as f64)
}
