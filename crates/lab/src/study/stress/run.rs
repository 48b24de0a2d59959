//! Execution of a stress test.

use crate::results::Document;
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::built_in::DEFAULT_POLICY;
use crate::results::Ending;
use crate::trial::Trial;
use vibrissa_language::{compile, gather};
use vibrissa_runtime::machine::Program;
use vibrissa_runtime::units::Dimension;
use vibrissa_text::diagnostic::Source;

use super::case::{Drive, StressCase};
use super::stability::StabilityCase;

/// The result of a stress test or of a search for the largest stable step.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(tag = "kind", rename_all = "lowercase")]
pub enum StressRow {
    /// The result of a stress test.
    Case {
        /// Name of the difficulty.
        name: String,
        /// The world.
        world: String,
        /// The drive of the platform.
        drive: String,
        /// Outcome of the run.
        outcome: Ending,
        /// Reason of the outcome. `None` for a completed run.
        reason: Option<String>,
        /// Simulated time.
        sim_s: f64,
        /// True if every number of the trace and the result is finite. Standard deviations of tips beyond the range of
        /// a contact estimator are excepted.
        finite: bool,
    },
    /// The result of a search.
    Step {
        /// The setting.
        name: String,
        /// The world.
        world: String,
        /// The largest stable step. `None` if 0.1 ms is not stable.
        largest_ms: Option<f64>,
        /// Reason of a missing result.
        reason: Option<String>,
    },
}

impl Document for StressRow {
    const FORMAT: &'static str = "stress";
    // A run that met its stop condition but not all expectations was `completed`.
    const VERSION: u32 = 2;
}

impl StressRow {
    /// True if the outcome is regular and all numbers are finite.
    #[must_use]
    pub fn is_sound(&self) -> bool {
        match self {
            Self::Case { outcome, finite, .. } => *outcome != Ending::Crashed && *finite,
            Self::Step { reason, .. } => reason.is_none(),
        }
    }
}

impl StressCase {
    /// Runs the case.
    #[must_use]
    pub fn run(&self) -> StressRow {
        let program = match self.drive.program() {
            Ok(program) => Arc::new(program),
            // A fault of this program, not an outcome of a run.
            Err(reason) => return self.crashed(reason),
        };
        let mut trial = Trial::new(self.scene.clone(), program);
        trial.world = self.world.into();
        let result = match trial.run() {
            Ok(result) => result,
            Err(cause) => return self.row(Ending::Refused, Some(cause.to_string()), 0.0, true),
        };
        let (document, ending, time) = (trial.document(&result), result.ending(), result.score.time);
        // JSON has no infinite numbers. They would read as missing figures.
        let run = result.run;
        let mut trace = run.trace;
        // Only these may be infinite: beyond the range of a contact estimator the position is unknown.
        for whisker in trace.ticks.iter_mut().flat_map(|tick| &mut tick.whiskers) {
            if whisker.tip_deviation.is_infinite() {
                whisker.tip_deviation = 0.0;
            }
        }
        let finite = is_finite(&format!("{document:?}")) && is_finite(&format!("{trace:?}"));
        self.row(ending, run.reason, time, finite)
    }

    /// The row of a case whose process crashed.
    pub(super) fn crashed(&self, reason: String) -> StressRow {
        self.row(Ending::Crashed, Some(reason), 0.0, true)
    }

    fn row(&self, outcome: Ending, reason: Option<String>, sim_s: f64, finite: bool) -> StressRow {
        let (name, world, drive) = (self.name.clone(), self.world.to_string(), self.drive.to_string());
        StressRow::Case { name, world, drive, outcome, reason, sim_s, finite }
    }
}

impl StabilityCase {
    /// Searches the largest stable step.
    #[must_use]
    pub fn run(&self) -> StressRow {
        let (largest, reason) = match self.largest_stable_step() {
            Ok(largest) => (largest, None),
            Err(cause) => (None, Some(cause.to_string())),
        };
        let (name, world) = (self.name.clone(), self.world.to_string());
        StressRow::Step { name, world, largest_ms: largest.map(|step| 1e3 * step), reason }
    }
}

impl Drive {
    /// The program of this drive.
    fn program(self) -> Result<Program, String> {
        let (path, text) = match self {
            Self::Policy => (DEFAULT_POLICY.path, DEFAULT_POLICY.text),
            Self::Straight(..) => ("straight.fsm", include_str!("straight.fsm")),
        };
        let source = gather(&Source::new(path, text), &mut |path| Err(format!("{path} is not built in")));
        let mut program = compile(&source).map_err(|faults| format!("{path} does not compile: {faults:?}"))?;
        if let Self::Straight(speed, turning) = self {
            let set = program.set("speed", speed, Dimension::SPEED);
            let set = set.and_then(|()| program.set("spin", turning, Dimension::ANGULAR_SPEED));
            set.map_err(|cause| cause.to_string())?;
        }
        Ok(program)
    }
}

impl std::fmt::Display for Drive {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Policy => f.write_str("policy"),
            Self::Straight(..) => f.write_str("straight"),
        }
    }
}

/// True if a text in Rust's debug format has no number that is not finite.
fn is_finite(debug: &str) -> bool {
    debug.split(|letter: char| !letter.is_alphanumeric()).all(|word| word != "NaN" && word != "inf")
}

#[cfg(test)]
mod tests {
    use super::is_finite;

    #[test]
    fn what_is_no_finite_number_is_seen_wherever_it_stands() {
        assert!(is_finite(&format!("{:?}", (Some(1.5), "informed", [f64::MAX]))));
        for number in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            assert!(!is_finite(&format!("{:?}", Some([1.0, number]))), "{number}");
        }
    }
}
