//! The outcomes of runs, judged by the expectations of their scenarios.

use std::fmt;

use serde::{Deserialize, Serialize};

use crate::run::Run;
use crate::score::Score;
use vibrissa_declare::figures::Metric;
use vibrissa_world::scene::{Expectation, Outcome, Violation};

vibrissa_runtime::kinds! {
    /// The outcome of a run, judged by the expectations of its scenario.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
    #[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
    #[serde(rename_all = "lowercase")]
    pub enum Ending,
    /// The name in results and tables.
    fn name {
        /// The run met its stop condition, and the expectations of its scenario hold.
        Completed = "completed",
        /// The run met its stop condition, but not all expectations of its scenario hold.
        Ended = "ended",
        /// The run reached its time limit.
        Timeout = "timeout",
        /// The run failed.
        Failed = "failed",
        /// The simulation cannot be trusted.
        Diverged = "diverged",
        /// The process of the run crashed.
        Crashed = "crashed",
        /// The run could not begin.
        Refused = "refused",
    }
}

impl Ending {
    /// The outcome of a run with these violations of its scenario.
    #[must_use]
    pub fn new(outcome: Outcome, violations: &[Violation]) -> Self {
        match outcome {
            Outcome::Completed if violations.is_empty() => Self::Completed,
            Outcome::Completed => Self::Ended,
            Outcome::Timeout => Self::Timeout,
            Outcome::Failed => Self::Failed,
            Outcome::Diverged => Self::Diverged,
            Outcome::Refused => Self::Refused,
        }
    }

    /// True if the run met its stop condition. The figures of other runs are of a part of the task, and mislead in a mean.
    #[must_use]
    pub const fn met_its_stop(self) -> bool {
        matches!(self, Self::Completed | Self::Ended)
    }

    /// True if there was a run.
    #[must_use]
    pub const fn took_place(self) -> bool {
        !matches!(self, Self::Crashed | Self::Refused)
    }
}

impl fmt::Display for Ending {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// The expectations that a run violates, and the contracts of its policy if it violates any.
#[must_use]
pub fn unmet(expectations: &[Expectation], run: &Run, score: &Score) -> Vec<Violation> {
    let violations = expectations.iter().filter_map(|one| one.violation(run.outcome, |metric| score.figure(metric)));
    let violated = run.contracts.iter().filter(|contract| contract.violations > 0).count();
    violations.chain((violated > 0).then_some(Violation::Contracts { violated })).collect()
}

/// The description of a violation, with the `reason` of the outcome if there is one.
#[must_use]
pub(super) fn described(violation: &Violation, reason: Option<&str>) -> String {
    match (violation, reason) {
        (Violation::Outcome { found, .. }, Some(reason)) => format!("{found}: {reason}"),
        _ => violation.to_string(),
    }
}

/// True if the violation is that of a bound of the largest error.
pub(super) fn is_of_largest_error(violation: &Violation) -> bool {
    matches!(violation, Violation::Bound { metric: Metric::ErrorMax, .. })
}
