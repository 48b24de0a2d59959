//! One figure of two policies, compared in pairs of runs.

use serde::Serialize;
use statrs::distribution::{Beta, ContinuousCDF};

use crate::score::Statistics;

use super::figure::Figure;

/// The result of a comparison.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum Outlook {
    /// The interval contains only differences in favour of the policy.
    Better,
    /// The interval contains only differences in favour of the first policy.
    Worse,
    /// No pair differs.
    Same,
    /// The interval contains zero: the difference is not significant.
    Open,
}

/// The mean difference of a policy from the first, with its confidence interval.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Difference {
    /// The mean of this policy minus that of the first.
    pub mean: f64,
    /// The 95 % confidence interval of the mean: [`Statistics::mean_interval`], and for a share of runs an exact one, after Clopper
    /// and Pearson, over the pairs that differ. `None` with fewer than two pairs.
    pub interval: Option<[f64; 2]>,
}

/// One figure of one policy compared with the first, over the pairs in which both have it.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct FigureComparison {
    /// Name of the figure, with its unit.
    pub figure: &'static str,
    /// The policy.
    pub policy: String,
    /// Number of pairs.
    pub pairs: usize,
    /// Mean of the first policy.
    pub first: f64,
    /// Mean of this one.
    pub mean: f64,
    /// The mean difference.
    pub difference: Difference,
    /// Number of pairs in which this policy is better.
    pub wins: usize,
    /// Number of pairs in which it is worse.
    pub losses: usize,
    /// The result.
    pub outlook: Outlook,
}

impl FigureComparison {
    /// Compares `pairs` of values, the first policy's before the other's. `None` without a pair. Pairs with a value
    /// that is not finite are omitted.
    #[must_use]
    pub fn new(figure: &Figure, policy: &str, mut pairs: Vec<(f64, f64)>) -> Option<Self> {
        pairs.retain(|(first, other)| first.is_finite() && other.is_finite());
        let mean = |of: fn(&(f64, f64)) -> f64| Some(Statistics::of(pairs.iter().map(of).collect())?.mean());
        let (first_mean, other_mean) = (mean(|pair| pair.0)?, mean(|pair| pair.1)?);
        let differences = Statistics::of(pairs.iter().map(|(first, other)| other - first).collect())?;
        let better =
            |&&(first, other): &&(f64, f64)| if figure.larger_is_better { other > first } else { other < first };
        let ties = pairs.iter().filter(|(first, other)| first.total_cmp(other).is_eq()).count();
        let wins = pairs.iter().filter(better).count();
        let interval = if figure.is_share() {
            (pairs.len() > 1).then(|| share_interval(wins, pairs.len() - wins - ties, pairs.len()))
        } else {
            differences.mean_interval()
        };
        let difference = Difference { mean: differences.mean(), interval };
        let sign = if figure.larger_is_better { -1.0 } else { 1.0 };
        let outlook = match difference.interval {
            _ if ties == pairs.len() => Outlook::Same,
            Some(ends) if ends.iter().all(|end| sign * end < 0.0) => Outlook::Better,
            Some(ends) if ends.iter().all(|end| sign * end > 0.0) => Outlook::Worse,
            _ => Outlook::Open,
        };
        Some(Self {
            figure: figure.name,
            policy: policy.to_owned(),
            pairs: pairs.len(),
            first: first_mean,
            mean: other_mean,
            difference,
            wins,
            losses: pairs.len() - wins - ties,
            outlook,
        })
    }
}

/// The 95 % interval of the difference of two shares of `pairs` runs, of which `gained` pairs and `lost` pairs differ.
///
/// Without a difference of the policies, each pair that differs is gained or lost with equal probability. So the interval contains
/// zero exactly if the sign test over these pairs is not significant. Student's t is not meant for values of 0 and 1: it finds a
/// difference in four lost pairs of twenty, which chance causes in one comparison of eight.
fn share_interval(gained: usize, lost: usize, pairs: usize) -> [f64; 2] {
    let differing = (gained + lost) as f64;
    // The bound of a share of which `count` and no fewer occurred in `differing` pairs (Clopper and Pearson 1934).
    let least = |count: usize| {
        let count = count as f64;
        let share = Beta::new(count, differing - count + 1.0).map(|beta| beta.inverse_cdf(TAIL));
        share.unwrap_or(0.0)
    };
    let ends = [least(gained), 1.0 - least(lost)];
    ends.map(|share| (2.0 * share - 1.0) * differing / pairs as f64)
}

/// Probability of a value beyond one end of a 95 % interval.
const TAIL: f64 = 0.025;
