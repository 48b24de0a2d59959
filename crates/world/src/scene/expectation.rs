//! Conditions on the result of a run.

use std::fmt;

use vibrissa_declare::figures::{Kind, Metric};
use vibrissa_runtime::units::{Dimension, format_si};

/// The outcome of a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema), schemars(rename_all = "lowercase"))]
pub enum Outcome {
    /// The run met its stop condition: its loop closed, its goal was reached, or its time ended in a scenario without a
    /// goal.
    Completed,
    /// The time limit was reached before the goal.
    Timeout,
    /// The policy failed.
    Failed,
    /// The simulation can no longer be trusted.
    Diverged,
    /// The run could not begin. No scenario can expect that.
    Refused,
}

/// A condition on the result of a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Expectation {
    /// The run has this outcome.
    Outcome(Outcome),
    /// The figure is at most the bound, or at least the bound for a figure of which
    /// [larger values are better](vibrissa_declare::figures::Figure::larger_is_better).
    Bound {
        /// The metric.
        metric: Metric,
        /// The bound, in SI units.
        bound: f64,
    },
}

/// An expectation that does not hold, with the measured value. Its text states both.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Violation {
    /// The outcome differs.
    Outcome {
        /// The expected outcome.
        expected: Outcome,
        /// The actual outcome.
        found: Outcome,
    },
    /// A figure exceeds its bound.
    Bound {
        /// The metric.
        metric: Metric,
        /// The bound, in SI units.
        bound: f64,
        /// The value, in SI units; `None` if the run has none.
        found: Option<f64>,
    },
    /// The policy violated contracts of its own.
    Contracts {
        /// Number of violated contracts.
        violated: usize,
    },
}

impl Outcome {
    /// All outcomes of a run that has begun.
    pub const ALL: [Self; 4] = [Self::Completed, Self::Timeout, Self::Failed, Self::Diverged];

    /// The name in scenarios and results.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Completed => "completed",
            Self::Timeout => "timeout",
            Self::Failed => "failed",
            Self::Diverged => "diverged",
            Self::Refused => "refused",
        }
    }
}

impl fmt::Display for Outcome {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// A value (SI) of a figure as text, with its unit.
fn text(metric: Metric, value: f64) -> String {
    let figure = metric.figure();
    if figure.kind == Kind::Share {
        format!("{} %", format_si(value * 100.0, Dimension::NUMBER))
    } else {
        format_si(value, figure.dimension())
    }
}

impl Expectation {
    /// Returns the violation by a run with this outcome and these figures, or `None` if the expectation holds. A figure
    /// that is missing or not a number violates its bound.
    pub fn violation(&self, outcome: Outcome, figure: impl Fn(Metric) -> Option<f64>) -> Option<Violation> {
        match *self {
            Self::Outcome(expected) => (expected != outcome).then_some(Violation::Outcome { expected, found: outcome }),
            Self::Bound { metric, bound } => {
                let found = figure(metric);
                let holds =
                    found.is_some_and(
                        |value| if metric.figure().larger_is_better() { value >= bound } else { value <= bound },
                    );
                (!holds).then_some(Violation::Bound { metric, bound, found })
            }
        }
    }
}

impl fmt::Display for Violation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Outcome { expected, found } => write!(f, "the outcome is {found}, expected {expected}"),
            Self::Contracts { violated: 1 } => f.write_str("the policy violated one of its contracts"),
            Self::Contracts { violated } => write!(f, "the policy violated {violated} of its contracts"),
            Self::Bound { metric, bound, found } => {
                let found = found.map_or("not known".to_owned(), |value| text(metric, value));
                let side = if metric.figure().larger_is_better() { "at least" } else { "at most" };
                write!(f, "{} is {found}, expected {side} {}", metric.name(), text(metric, bound))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn violation(metric: Metric, bound: f64, found: Option<f64>) -> Option<String> {
        let expectation = Expectation::Bound { metric, bound };
        expectation.violation(Outcome::Completed, |_| found).map(|violation| violation.to_string())
    }

    #[test]
    fn errors_are_bounded_from_above_and_coverage_from_below() {
        assert_eq!(violation(Metric::ErrorMean, 8e-4, Some(8e-4)), None);
        assert_eq!(
            violation(Metric::ErrorMean, 8e-4, Some(1.2e-3)).as_deref(),
            Some("error_mean is 1.2 mm, expected at most 800 um")
        );
        assert_eq!(violation(Metric::Coverage, 0.95, Some(0.95)), None);
        assert_eq!(
            violation(Metric::Coverage, 0.95, Some(0.5)).as_deref(),
            Some("coverage is 50 %, expected at least 95 %")
        );
    }

    #[test]
    fn a_figure_that_is_not_there_or_not_a_number_violates_its_bound() {
        assert!(violation(Metric::ErrorMax, 1.0, Some(f64::NAN)).is_some());
        assert_eq!(
            violation(Metric::ErrorMax, 0.001, None).as_deref(),
            Some("error_max is not known, expected at most 1 mm")
        );
    }

    #[test]
    fn another_outcome_is_a_violation() {
        let violation = Expectation::Outcome(Outcome::Completed).violation(Outcome::Timeout, |_| None);
        assert_eq!(
            violation.map(|violation| violation.to_string()).as_deref(),
            Some("the outcome is timeout, expected completed")
        );
    }
}
