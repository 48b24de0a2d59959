//! Conditions on the result of a run.

use std::fmt;
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

/// A figure of a run that an expectation can bound.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Metric {
    /// Mean distance of the tip estimates from the object (m).
    ErrorMean,
    /// 95th percentile of this distance (m).
    ErrorP95,
    /// Maximum of this distance (m).
    ErrorMax,
    /// Coverage of the 95 % interval: the share of tip estimates within their own interval (0 to 1).
    IntervalCoverage,
    /// Share of the tip estimates that are outliers (0 to 1).
    Outliers,
    /// Hausdorff distance between the object and the estimated contour (m).
    Hausdorff,
    /// Share of the object's outline that was traced (0 to 1).
    Coverage,
    /// Share of the traced outline of the object whose loop closed (0 to 1).
    ObjectCoverage,
    /// Share of a tunnel's length that the platform passed between its walls (0 to 1).
    Passage,
    /// Share of a tunnel's inner sides that was traced between the first and the last contact (0 to 1).
    WallCoverage,
    /// Mean retrieval radius (m).
    RetrievalRadius,
    /// Mean retrieval distance (m).
    RetrievalDistance,
    /// Mean distance of the estimated midpoints from the axis of a tunnel (m).
    AxisMean,
    /// Largest distance of an estimated corner from the exact one (m).
    CornerPlaceMax,
    /// Longest time of a corner (s).
    CornerTimeMax,
    /// Longest path of the platform at a corner (m).
    CornerPathMax,
    /// Number of contacts of the platform's body.
    Collisions,
    /// Largest distance of a tip from the plane (m), in a spatial simulation.
    OutOfPlaneMax,
    /// Number of slips of tips out of the plane, in a spatial simulation.
    Slips,
    /// Time beyond the limit of the inclination, added over all whiskers.
    InclinationBeyond,
}

/// A condition on the result of a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Expectation {
    /// The run has this outcome.
    Outcome(Outcome),
    /// The figure is at most the bound, or at least the bound for a [metric with a lower
    /// bound](Metric::is_lower_bounded).
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

impl Metric {
    /// All metrics.
    pub const ALL: [Self; 20] = [
        Self::ErrorMean,
        Self::ErrorP95,
        Self::ErrorMax,
        Self::IntervalCoverage,
        Self::Outliers,
        Self::Hausdorff,
        Self::Coverage,
        Self::ObjectCoverage,
        Self::Passage,
        Self::WallCoverage,
        Self::RetrievalRadius,
        Self::RetrievalDistance,
        Self::AxisMean,
        Self::CornerPlaceMax,
        Self::CornerTimeMax,
        Self::CornerPathMax,
        Self::Collisions,
        Self::OutOfPlaneMax,
        Self::Slips,
        Self::InclinationBeyond,
    ];

    /// The name in scenarios.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::ErrorMean => "error_mean",
            Self::ErrorP95 => "error_p95",
            Self::ErrorMax => "error_max",
            Self::IntervalCoverage => "interval_coverage",
            Self::Outliers => "outliers",
            Self::Hausdorff => "hausdorff",
            Self::Coverage => "coverage",
            Self::ObjectCoverage => "object_coverage",
            Self::Passage => "passage",
            Self::WallCoverage => "wall_coverage",
            Self::RetrievalRadius => "retrieval_radius",
            Self::RetrievalDistance => "retrieval_distance",
            Self::AxisMean => "axis_mean",
            Self::CornerPlaceMax => "corner_place_max",
            Self::CornerTimeMax => "corner_time_max",
            Self::CornerPathMax => "corner_path_max",
            Self::Collisions => "collisions",
            Self::OutOfPlaneMax => "out_of_plane_max",
            Self::Slips => "slips",
            Self::InclinationBeyond => "inclination_beyond",
        }
    }

    /// The physical dimension.
    #[must_use]
    pub fn dimension(self) -> Dimension {
        match self {
            _ if self.is_count() => Dimension::NUMBER,
            _ if self.is_share() => Dimension::NUMBER,
            Self::CornerTimeMax | Self::InclinationBeyond => Dimension::TIME,
            _ => Dimension::LENGTH,
        }
    }

    /// True if larger values are better, so that the bound is a lower bound.
    #[must_use]
    pub fn is_lower_bounded(self) -> bool {
        self.is_share() && self != Self::Outliers
    }

    /// True for a share from 0 to 1.
    #[must_use]
    pub fn is_share(self) -> bool {
        matches!(
            self,
            Self::IntervalCoverage
                | Self::Outliers
                | Self::Coverage
                | Self::ObjectCoverage
                | Self::Passage
                | Self::WallCoverage
        )
    }

    /// True for a number of events.
    #[must_use]
    pub fn is_count(self) -> bool {
        matches!(self, Self::Collisions | Self::Slips)
    }

    fn format(self, value: f64) -> String {
        if self.is_share() {
            format!("{} %", format_si(value * 100.0, Dimension::NUMBER))
        } else {
            format_si(value, self.dimension())
        }
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
                    found.is_some_and(|value| if metric.is_lower_bounded() { value >= bound } else { value <= bound });
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
                let found = found.map_or("not known".to_owned(), |value| metric.format(value));
                let side = if metric.is_lower_bounded() { "at least" } else { "at most" };
                write!(f, "{} is {found}, expected {side} {}", metric.name(), metric.format(bound))
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
