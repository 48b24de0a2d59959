//! JSON documents of transitions and stops.

use serde::Serialize;

use vibrissa_runtime::machine::{Standing, TIME_SLACK};
use vibrissa_runtime::units::{Dimension, format_si};

use crate::results::Document;
use vibrissa_language::explain::{ExplainedTransition, Judged};

/// A transition that was taken. Its serialised form is a line that `run --transitions` writes.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct TransitionLine {
    /// Name of the scenario.
    pub scenario: String,
    /// Time since the start of the run.
    pub time_s: f64,
    /// Index of the tick.
    pub tick: usize,
    /// The innermost state that was active before.
    pub left: String,
    /// Number of ticks that this state was active. 0 if it was entered in the same tick.
    pub ticks_in_state: usize,
    /// The transition.
    pub taken: GuardRecord,
    /// The other guards that were tried, in the order in which they were tried.
    pub others: Vec<GuardRecord>,
}

impl Document for TransitionLine {
    const FORMAT: &'static str = "transition";
}

/// A contract that was violated. Its serialised form is a line that `run --transitions` writes.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct ViolationLine {
    /// Name of the scenario.
    pub scenario: String,
    /// Time since the start of the run.
    pub time_s: f64,
    /// Index of the tick.
    pub tick: usize,
    /// The state to which the contract belongs. `None` for a contract of the whole machine.
    pub state: Option<String>,
    /// The contract, as in the policy.
    pub contract: String,
    /// The file that contains it. `None` for the policy itself.
    pub file: Option<String>,
    /// Its line in that file.
    pub line: usize,
    /// The parts of the condition of its violation.
    pub parts: Vec<LeafRecord>,
}

impl Document for ViolationLine {
    const FORMAT: &'static str = "violation";
}

/// A guard with its standing.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct GuardRecord {
    /// The state to which the transition belongs. `None` for a global transition.
    pub state: Option<String>,
    /// The guard, as in the policy.
    pub guard: String,
    /// The file that contains it. `None` for the policy itself.
    pub file: Option<String>,
    /// Its line in that file.
    pub line: usize,
    /// The target.
    pub target: String,
    /// True if the condition holds.
    pub is_met: bool,
    /// Time for which the condition has held, for a guard with a time.
    pub elapsed_s: Option<f64>,
    /// The time that is needed. `None` also if it is not finite.
    pub needed_s: Option<f64>,
    /// The parts of the condition. Of a condition that does not hold, only the parts that are missing.
    pub parts: Vec<LeafRecord>,
}

/// A part of a condition: a comparison or a bool.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct LeafRecord {
    /// The part, as in the policy or in a library.
    pub text: String,
    /// True if it holds.
    pub holds: bool,
    /// Of a comparison of numbers, the distance from the value where it changes. `None` if it is not finite.
    pub margin: Option<Margin>,
}

/// The distance of a comparison from the value where it changes.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Margin {
    /// The distance, positive if the comparison holds.
    pub value: f64,
    /// Its unit.
    pub unit: String,
    /// Both, for people.
    #[serde(skip)]
    pub text: String,
}

/// A run that stopped at a breakpoint.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct StopRecord {
    /// Name of the scenario.
    pub scenario: String,
    /// The breakpoint.
    pub breakpoint: String,
    /// Time since the start of the run.
    pub time_s: f64,
    /// Index of the tick.
    pub tick: usize,
    /// The active states, from the outermost to the innermost.
    pub states: Vec<String>,
    /// The transitions that were taken in this tick.
    pub taken: Vec<GuardRecord>,
    /// The guards of the active states, in the order in which they were tried after these.
    pub guards: Vec<GuardRecord>,
    /// Memory of the machine, and arguments and memory of the active states.
    pub variables: Vec<VariableRecord>,
}

impl Document for StopRecord {
    const FORMAT: &'static str = "stop";
}

/// A value that the machine keeps from tick to tick.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct VariableRecord {
    /// The state to which it belongs. `None` for memory of the machine.
    pub state: Option<String>,
    /// Its name.
    pub name: String,
    /// Its value with its unit.
    pub value: String,
}

impl LeafRecord {
    pub(super) fn new(judged: &Judged<'_>) -> Self {
        let margin = judged.margin.filter(|(value, _)| value.is_finite()).map(|(value, dimension)| Margin {
            value,
            unit: dimension.si_unit(),
            text: format_si(value.abs(), dimension),
        });
        Self { text: judged.leaf.text.clone(), holds: judged.holds, margin }
    }
}

impl GuardRecord {
    pub(super) fn new(
        state: Option<String>,
        transition: &ExplainedTransition,
        standing: Standing,
        registers: &[f64],
    ) -> Self {
        let parts = transition
            .condition
            .as_ref()
            .map(|condition| if standing.is_met { condition.judge(registers) } else { condition.missing(registers) });
        Self {
            state,
            guard: transition.text.clone(),
            file: transition.file.clone(),
            line: transition.position.line,
            target: transition.target.clone(),
            is_met: standing.is_met,
            elapsed_s: standing.duration.map(|duration| duration.elapsed),
            needed_s: standing.duration.map(|duration| duration.needed).filter(|needed| needed.is_finite()),
            parts: parts.unwrap_or_default().iter().map(LeafRecord::new).collect(),
        }
    }

    /// What the guard lacks, for people. Empty if it is enabled.
    #[must_use]
    pub fn missing(&self) -> String {
        if !self.is_met {
            let part = |part: &LeafRecord| match &part.margin {
                Some(margin) => format!("`{}` by {}", part.text, margin.text),
                None => format!("`{}`", part.text),
            };
            return self.parts.iter().map(part).collect::<Vec<_>>().join(", ");
        }
        match (self.elapsed_s, self.needed_s) {
            (Some(elapsed), Some(needed)) if elapsed < needed - TIME_SLACK => {
                let [elapsed, needed] = [elapsed, needed].map(|time| format_si(time, Dimension::TIME));
                format!("{elapsed} of {needed} elapsed")
            }
            _ => String::new(),
        }
    }
}
