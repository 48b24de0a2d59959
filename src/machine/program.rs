//! What a policy compiles to.

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::units::{Dimension, format_si};

use super::op::{Block, Op, Register};

/// The most operations that a program may have.
pub const CODE_LIMIT: usize = 50_000;
/// The most registers that a program may have.
pub const REGISTER_LIMIT: usize = 60_000;

/// The most bytes that the description of a parameter may have.
pub const DESCRIPTION_LIMIT: usize = 500;

/// A compiled policy.
///
/// Registers hold, in this order, the parameters, then constants, states' arguments and temporaries as the compiler laid
/// them out; [`Program::image`] is what they hold at the start of a run. A program that does not come from the compiler or an
/// [`Artifact`](super::Artifact) is safe to run if it passes [`Program::verify`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Program {
    /// The machine's name.
    pub name: String,
    /// The whiskers that the policy binds, by their names in the rig.
    pub whiskers: Vec<String>,
    /// The parameters; the one with index `i` lives in register `i`.
    pub parameters: Vec<Parameter>,
    /// The states.
    pub states: Vec<State>,
    /// Index of the state that a run starts in.
    pub initial: usize,
    /// Transitions that are tried first, whatever the state.
    pub always: Vec<Transition>,
    /// All code; blocks are ranges of it.
    pub code: Vec<Op>,
    /// The register file at the start of a run.
    pub image: Vec<f64>,
    /// Number of timers that guards with a duration need; those of `always` come first.
    pub timers: usize,
}

/// A number that a run may set within a range.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Parameter {
    /// Its name.
    pub name: String,
    /// What the policy says about it: one line of at most [`DESCRIPTION_LIMIT`] bytes, which may be empty.
    pub description: String,
    /// Its dimension.
    pub dimension: Dimension,
    /// Its value if a run sets none (SI).
    pub default: f64,
    /// The least and greatest value allowed (SI).
    pub range: Option<(f64, f64)>,
}

/// A state.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct State {
    /// Its name.
    pub name: Arc<str>,
    /// What it does when it is entered, before anything else: sets its memory.
    pub entry: Block,
    /// What it does every tick.
    pub body: Block,
    /// What it does when it is left.
    pub exit: Block,
    /// Its transitions in the order in which they are tried.
    pub transitions: Vec<Transition>,
}

/// A way out of a state.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Transition {
    /// When it is taken.
    pub guard: Guard,
    /// Where it leads.
    pub target: Target,
}

/// When a transition is taken.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Guard {
    /// When a condition holds.
    When {
        /// Computes the condition.
        code: Block,
        /// Where the condition is afterwards.
        truth: Register,
        /// For how long it must have held without a break (register of a time in s), and the timer that watches.
        lasting: Option<(Register, usize)>,
    },
    /// When the state has been active for a time.
    After {
        /// Computes the time.
        code: Block,
        /// Where the time (s) is afterwards.
        time: Register,
    },
}

impl Guard {
    /// Whether the guard needs a timer.
    #[must_use]
    pub fn is_timed(&self) -> bool {
        matches!(self, Self::When { lasting: Some(_), .. })
    }
}

/// Where a transition leads.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Target {
    /// Into a state.
    State {
        /// Its index.
        state: usize,
        /// Computes the arguments and puts them where the state reads them.
        arguments: Block,
    },
    /// To the end of the run, in failure, for this reason.
    Failure(Arc<str>),
}

/// Why a parameter cannot be set.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SetError {
    /// There is no such parameter.
    #[error("the policy has no parameter `{name}`; it has {known}")]
    Unknown {
        /// What was asked for.
        name: String,
        /// The parameters that there are.
        known: String,
    },
    /// The value has the wrong dimension.
    #[error("`{name}` is {} {expected}, not {} {found}", article(expected), article(found))]
    Dimension {
        /// The parameter.
        name: String,
        /// Its dimension.
        expected: String,
        /// The value's dimension.
        found: String,
    },
    /// The value is not a finite number.
    #[error("`{name}` must be a finite number")]
    NotFinite {
        /// The parameter.
        name: String,
    },
    /// The value is outside of the range.
    #[error("`{name}` must lie between {low} and {high}; {value} does not")]
    Range {
        /// The parameter.
        name: String,
        /// The value.
        value: String,
        /// The least value allowed.
        low: String,
        /// The greatest value allowed.
        high: String,
    },
}

fn article(noun: &str) -> &'static str {
    if noun.starts_with(['a', 'e', 'i', 'o', 'u']) { "an" } else { "a" }
}

impl Guard {
    /// What computes it.
    pub(super) fn code(&self) -> &Block {
        match self {
            Self::When { code, .. } | Self::After { code, .. } => code,
        }
    }
}

impl Program {
    /// The most operations that a tick in the state with this index does without leaving it: all guards, and what the state
    /// does. Jumps only lead forward, so that a block never does more operations than it has.
    #[must_use]
    pub fn operations(&self, state: usize) -> usize {
        let state = &self.states[state];
        let guards = self.always.iter().chain(&state.transitions).map(|transition| transition.guard.code().len());
        guards.sum::<usize>() + state.body.len()
    }

    /// Sets the parameter `name` to `value` (SI), which has the dimension `dimension`.
    ///
    /// # Errors
    /// [`SetError`] when there is no such parameter, its dimension or range is another, or the value is not finite.
    pub fn set(&mut self, name: &str, value: f64, dimension: Dimension) -> Result<(), SetError> {
        let Some(index) = self.parameters.iter().position(|parameter| parameter.name == name) else {
            let known = self.parameters.iter().map(|parameter| format!("`{}`", parameter.name)).collect::<Vec<_>>();
            let known = if known.is_empty() { "none".to_owned() } else { known.join(", ") };
            return Err(SetError::Unknown { name: name.to_owned(), known });
        };
        let parameter = &self.parameters[index];
        if parameter.dimension != dimension {
            return Err(SetError::Dimension {
                name: name.to_owned(),
                expected: parameter.dimension.to_string(),
                found: dimension.to_string(),
            });
        }
        if !value.is_finite() {
            return Err(SetError::NotFinite { name: name.to_owned() });
        }
        if let Some((low, high)) = parameter.range
            && !(low..=high).contains(&value)
        {
            return Err(SetError::Range {
                name: name.to_owned(),
                value: format_si(value, dimension),
                low: format_si(low, dimension),
                high: format_si(high, dimension),
            });
        }
        self.image[index] = value;
        Ok(())
    }
}
