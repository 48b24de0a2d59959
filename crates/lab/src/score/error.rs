//! The errors of a run's tip estimates.

use std::collections::BTreeMap;

use vibrissa_runtime::math;

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
    /// Bias (m): the mean magnitude of the bias of the tips, where the bias of a tip is the mean signed distance of its
    /// whisker's tips from the true tips, perpendicular to the outline.
    pub bias: Option<f64>,
    /// Scatter (m): the standard deviation of the tips of a whisker about its bias. `None` also if no whisker has two
    /// tips.
    pub scatter: Option<f64>,
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
            let distances = tips.iter().filter_map(|tip| Some(part(tip.offset.as_ref()?).abs()));
            let statistics = Statistics::of(distances.collect())?;
            Some(TipDistance { mean: statistics.mean(), p95: statistics.percentile(95.0), max: statistics.max() })
        };
        let (bias, scatter) = bias_and_scatter(tips);
        Some(Self {
            mean: statistics.mean(),
            std: statistics.std(),
            p95: statistics.percentile(95.0),
            max: statistics.max(),
            interval_coverage: share(&|tip| tip.error <= INTERVAL_DEVIATIONS * tip.standard_deviation),
            outliers: share(&Tip::is_outlier),
            along: distance(|offset| offset.along),
            across: distance(|offset| offset.across),
            bias,
            scatter,
            count: statistics.count(),
        })
    }
}

/// The [bias](ErrorFigures::bias) and the [scatter](ErrorFigures::scatter) of tips.
fn bias_and_scatter(tips: &[Tip]) -> (Option<f64>, Option<f64>) {
    let mut of_whiskers = BTreeMap::<usize, Vec<f64>>::new();
    for tip in tips {
        if let Some(offset) = &tip.offset {
            of_whiskers.entry(tip.whisker).or_default().push(offset.across);
        }
    }
    let whiskers: Vec<Statistics> = of_whiskers.into_values().filter_map(Statistics::of).collect();
    let count: usize = whiskers.iter().map(Statistics::count).sum();
    let bias: f64 = whiskers.iter().map(|whisker| whisker.count() as f64 * whisker.mean().abs()).sum();
    // Each mean takes one degree of freedom.
    let squares = |whisker: &Statistics| Some((whisker.count() - 1) as f64 * math::square(whisker.std()?));
    let squares: f64 = whiskers.iter().filter_map(squares).sum();
    let freedom = count - whiskers.len();
    ((count > 0).then(|| bias / count as f64), (freedom > 0).then(|| (squares / freedom as f64).sqrt()))
}
