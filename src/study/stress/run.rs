//! What becomes of a case.

use crate::results::Document;
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::built_in::DEFAULT_POLICY;
use crate::diagnostic::Source;
use crate::policy::{compile, gather};
use crate::results::Ending;
use crate::trial::Trial;
use vibrissa_runtime::machine::Program;
use vibrissa_runtime::units::Dimension;

use super::case::{Drive, StressCase};
use super::stability::StabilityCase;

/// What became of a case, or of the search for a largest stable step.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(tag = "kind", rename_all = "lowercase")]
pub enum StressRow {
    /// Of a case.
    Case {
        /// What is hard about it.
        name: String,
        /// The world.
        world: String,
        /// How the platform was driven.
        drive: String,
        /// How it ended.
        outcome: Ending,
        /// Why, if not as it should.
        reason: Option<String>,
        /// Simulated time.
        sim_s: f64,
        /// Whether every number of its trace and its result is finite, but for the spreads of tips beyond a tip model's range.
        finite: bool,
    },
    /// Of a search.
    Step {
        /// The setting.
        name: String,
        /// The world.
        world: String,
        /// The largest stable step; `None` if not even 0.1 ms is stable.
        largest_ms: Option<f64>,
        /// Why there is no answer, if there is none.
        reason: Option<String>,
    },
}

impl Document for StressRow {
    const FORMAT: &'static str = "stress";
}

impl StressRow {
    /// Whether it is as it must be: a typed end, and numbers that are finite.
    #[must_use]
    pub fn is_sound(&self) -> bool {
        match self {
            Self::Case { outcome, finite, .. } => *outcome != Ending::Crashed && *finite,
            Self::Step { reason, .. } => reason.is_none(),
        }
    }
}

impl StressCase {
    /// Runs it.
    #[must_use]
    pub fn run(&self) -> StressRow {
        let program = match self.drive.program() {
            Ok(program) => Arc::new(program),
            // A fault of this program, and no end of a run.
            Err(reason) => return self.crashed(reason),
        };
        let mut trial = Trial::new(self.scene.clone(), program);
        trial.world = self.world.into();
        let result = match trial.run() {
            Ok(result) => result,
            Err(cause) => return self.row(Ending::Refused, Some(cause.to_string()), 0.0, true),
        };
        let document = trial.document(&result);
        // JSON has no word for what is no number: it would read as a figure that the run does not have.
        let run = result.run;
        let mut trace = run.trace;
        // These alone may be infinite: beyond the range of a tip model nothing is known of the place.
        for spread in
            trace.ticks.iter_mut().flat_map(|tick| &mut tick.tip_spreads).filter(|spread| spread.is_infinite())
        {
            *spread = 0.0;
        }
        let finite = is_finite(&format!("{document:?}")) && is_finite(&format!("{trace:?}"));
        self.row(run.outcome.into(), run.reason, document.sim_s, finite)
    }

    /// The row of a case that ended its process.
    pub(super) fn crashed(&self, reason: String) -> StressRow {
        self.row(Ending::Crashed, Some(reason), 0.0, true)
    }

    fn row(&self, outcome: Ending, reason: Option<String>, sim_s: f64, finite: bool) -> StressRow {
        let (name, world, drive) = (self.name.clone(), self.world.to_string(), self.drive.to_string());
        StressRow::Case { name, world, drive, outcome, reason, sim_s, finite }
    }
}

impl StabilityCase {
    /// Searches.
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
    /// The program that drives so.
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

/// Whether there is no number in what something looks like to Rust that is not finite.
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
