//! The cost of runs that tuning minimises.

use std::fmt;

use crate::trial::TrialResult;
use vibrissa_declare::figures::{Kind, Metric};

/// The cost of a run that does not pass, before its share of progress counts.
const FAILED: f64 = 10.0;
/// The reciprocal of the unit to which figures are rounded. Rounded figures have the same bits after they were written and
/// read.
const ROUNDING: f64 = 1e9;

/// A figure with its weight.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Term {
    pub(crate) figure: Metric,
    /// Cost of a millimetre, a second or one.
    pub(crate) weight: f64,
}

/// The weighted figures of which a cost is made.
#[derive(Debug, Clone, PartialEq)]
pub struct Objective {
    terms: Vec<Term>,
}

/// True if an objective can have the figure: it has a name and a direction.
fn is_judged(metric: Metric) -> bool {
    let figure = metric.figure();
    figure.name.is_some() && figure.better.is_some()
}

/// The amount of a figure that is to be small, in millimetres, seconds or ones. A figure that is to be large is a share, and counts
/// by what is missing from 1. `None` if the run does not have the figure.
fn amount(metric: Metric, result: &TrialResult) -> Option<f64> {
    let value = result.score.figure(metric)?;
    Some(match metric.figure() {
        figure if figure.larger_is_better() => 1.0 - value,
        figure if figure.kind == Kind::Length => 1e3 * value,
        _ => value,
    })
}

impl Term {
    /// Reads `FIGURE=WEIGHT`.
    ///
    /// # Errors
    /// What to write instead.
    pub fn parse(text: &str) -> Result<Self, String> {
        let known = || {
            let metrics: Vec<&str> =
                Metric::ALL.into_iter().filter(|metric| is_judged(*metric)).map(Metric::name).collect();
            let metrics = metrics.join(", ");
            format!("write FIGURE=WEIGHT with a weight of 0 or more, such as error_mean=10; figures are {metrics}")
        };
        let (name, weight) = text.split_once('=').ok_or_else(known)?;
        let figure = Metric::named(name.trim()).filter(|metric| is_judged(*metric)).ok_or_else(known)?;
        let weight: f64 = weight.trim().parse().map_err(|_| known())?;
        if !weight.is_finite() || weight < 0.0 {
            return Err(known());
        }
        Ok(Self { figure, weight })
    }
}

impl Default for Objective {
    /// 0.1 mm of mean error cost as much as 100 s.
    fn default() -> Self {
        let error = Term { figure: Metric::ErrorMean, weight: 10.0 };
        Self { terms: vec![error, Term { figure: Metric::SimulatedTime, weight: 0.01 }] }
    }
}

impl fmt::Display for Objective {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (index, Term { figure, weight }) in self.terms.iter().enumerate() {
            let plus = if index == 0 { "" } else { " + " };
            write!(f, "{plus}{weight} {}", figure.name())?;
        }
        Ok(())
    }
}

impl Objective {
    /// The objective of these terms, or the default one if there are none.
    #[must_use]
    pub fn new(terms: &[Term]) -> Self {
        if terms.is_empty() { Self::default() } else { Self { terms: terms.to_vec() } }
    }

    /// The weighted sum of the figures of a run. `None` if it lacks one of them.
    pub(crate) fn sum(&self, result: &TrialResult) -> Option<f64> {
        let amounts = self.terms.iter().map(|term| Some(term.weight * amount(term.figure, result)?));
        amounts.sum::<Option<f64>>().filter(|sum| sum.is_finite())
    }

    /// The cost of a run, rounded. `passed` is true if it has satisfied the expectations of its scene.
    ///
    /// The sum `s` of a run that passed costs `s / (1 + s)`, which is less than 1. So no single run counts for much more than
    /// the others. A run that does not pass costs 10 to 11, less for a larger traced share of the object.
    pub(crate) fn cost(&self, result: &TrialResult, passed: bool) -> f64 {
        cost(self.sum(result).filter(|_| passed), result.score.coverage)
    }
}

/// The cost of a run with this sum, or of a failed one with this traced share (0 to 1).
fn cost(sum: Option<f64>, coverage: f64) -> f64 {
    let cost = sum.map_or_else(|| FAILED + 1.0 - coverage.clamp(0.0, 1.0), |sum| sum / (1.0 + sum));
    rounded(cost)
}

/// A figure without the digits that would not be read as they are written.
pub(super) fn rounded(figure: f64) -> f64 {
    (figure * ROUNDING).round() / ROUNDING
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn a_failed_run_is_worse_than_ten_others_and_progress_counts(sum in 0.0..1e12, less in 0.0..1.0, more in 0.0..1.0) {
            prop_assert!(10.0 * cost(Some(sum), 0.0) <= cost(None, 1.0));
            prop_assert!(cost(Some(sum), 0.0) <= cost(Some(1.01 * sum + 1e-6), 0.0));
            prop_assert!(less > more - 1e-8 || cost(None, more) < cost(None, less));
        }

        #[test]
        fn a_written_cost_reads_as_the_same_number(sum in 0.0..1e3, coverage in 0.0..1.0) {
            for cost in [cost(Some(sum), coverage), cost(None, coverage)] {
                let read: f64 = serde_json::from_str(&serde_json::to_string(&cost).unwrap()).unwrap();
                prop_assert_eq!(read.to_bits(), cost.to_bits());
            }
        }
    }

    #[test]
    fn a_term_names_a_figure_and_a_weight() {
        let term = Term::parse("error_p95=2.5").unwrap();
        assert_eq!(term, Term { figure: Metric::ErrorP95, weight: 2.5 });
        assert_eq!(Objective::new(&[term, Term::parse("time=1").unwrap()]).to_string(), "2.5 error_p95 + 1 time");
        for text in ["error", "error_mean=", "error_mean=-1", "error_mean=inf", "nothing=1"] {
            assert!(Term::parse(text).is_err(), "{text}");
        }
    }
}
