//! One figure of two policies, compared in pairs of runs.

use serde::Serialize;

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
    /// The 95 % confidence interval of the mean ([`Statistics::mean_interval`]). `None` with fewer than two pairs.
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
        let difference = Difference { mean: differences.mean(), interval: differences.mean_interval() };
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
