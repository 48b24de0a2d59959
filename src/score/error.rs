//! The errors of a run's tip estimates.

use super::{Statistics, Tip, TipOffset};

/// The distances of a run's tip estimates from the nearest surface, over all whiskers, in metres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ErrorFigures {
    /// Mean, the baseline's mean absolute error.
    pub mean: f64,
    /// Sample standard deviation, called standard error by the baseline. `None` for a single estimate.
    pub std: Option<f64>,
    /// 95th percentile, by [`Statistics::percentile`].
    pub p95: f64,
    /// Maximum.
    pub max: f64,
    /// Coverage of the 95 % interval: the share of estimates (0 to 1) whose error is at most 1.96 reported standard
    /// deviations.
    pub interval_coverage: f64,
    /// Share of the estimates (0 to 1) that are [outliers](Tip::is_outlier).
    pub outliers: f64,
    /// Their distances from the true tips along the outline. `None` if the true tips are unknown.
    pub along: Option<TipDistance>,
    /// Their distances from the true tips perpendicular to the outline.
    pub across: Option<TipDistance>,
    /// Number of estimates.
    pub count: usize,
}

/// Distances of tip estimates from the true tips in one direction (m).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TipDistance {
    /// Mean.
    pub mean: f64,
    /// 95th percentile.
    pub p95: f64,
    /// Maximum.
    pub max: f64,
}

/// The half-width of the 95 % interval of a normal distribution, in standard deviations.
const INTERVAL_DEVIATIONS: f64 = 1.96;

impl ErrorFigures {
    /// The figures of `tips`. `None` without tips.
    #[must_use]
    pub fn of(tips: &[Tip]) -> Option<Self> {
        let statistics = Statistics::of(tips.iter().map(|tip| tip.error).collect())?;
        let share =
            |counts: &dyn Fn(&Tip) -> bool| tips.iter().filter(|tip| counts(tip)).count() as f64 / tips.len() as f64;
        let distance = |part: fn(&TipOffset) -> f64| {
            let statistics = Statistics::of(tips.iter().filter_map(|tip| tip.offset.as_ref()).map(part).collect())?;
            Some(TipDistance { mean: statistics.mean(), p95: statistics.percentile(95.0), max: statistics.max() })
        };
        Some(Self {
            mean: statistics.mean(),
            std: statistics.std(),
            p95: statistics.percentile(95.0),
            max: statistics.max(),
            interval_coverage: share(&|tip| tip.error <= INTERVAL_DEVIATIONS * tip.standard_deviation),
            outliers: share(&Tip::is_outlier),
            along: distance(|offset| offset.along),
            across: distance(|offset| offset.across),
            count: statistics.count(),
        })
    }
}
