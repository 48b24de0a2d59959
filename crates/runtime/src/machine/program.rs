//! What a policy compiles to.

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::units::{Dimension, format_si};

use super::contact_estimator_kind::ContactEstimatorKind;
use super::op::{Block, Op, Register};
use super::tick::MICROSTEP_LIMIT;

/// The most operations that a program may have.
pub const CODE_LIMIT: usize = 50_000;
/// The most registers that a program may have.
pub const REGISTER_LIMIT: usize = 60_000;
/// How many states may lie in one another, so that a tick has a bounded number of them to see to.
pub const NESTING_LIMIT: usize = 8;

/// The most bytes that the description of a parameter may have.
pub const DESCRIPTION_LIMIT: usize = 500;

/// A compiled policy.
///
/// Registers hold, in this order, the parameters, then constants, states' arguments and temporaries as the compiler laid
/// them out; [`Program::initial_registers`] is what they hold at the start of a run. A program that does not come from the compiler or an
/// [`Artifact`](super::Artifact) is safe to run if it passes [`Program::verify`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Program {
    /// The machine's name.
    pub name: String,
    /// The whiskers that the policy binds, by their names in the rig.
    pub whiskers: Vec<String>,
    /// The tip model of each of them.
    pub contact_estimators: Vec<ContactEstimatorKind>,
    /// Whether a rig may lack each of them.
    pub optional: Vec<bool>,
    /// The parameters; the one with index `i` lives in register `i`.
    pub parameters: Vec<Parameter>,
    /// The states; an outer state comes before the states in it.
    pub states: Vec<State>,
    /// Index of the state that a run starts in.
    pub initial: usize,
    /// What is done once, when a run begins: computes what follows from parameters and constants alone.
    pub start: Block,
    /// What is done once behind that, before a state is entered: sets the machine's own memory.
    pub entry: Block,
    /// What is done every tick before what the active states do.
    pub body: Block,
    /// Transitions that are tried first, whatever the state.
    pub always: Vec<Transition>,
    /// Where a state without a failsafe of its own is left to when the machine cannot go on in it.
    pub fallback: Option<Target>,
    /// All code; blocks are ranges of it.
    pub code: Vec<Op>,
    /// The register file at the start of a run.
    pub initial_registers: Vec<f64>,
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
    /// Index of the state that it lies in, which is less than its own.
    pub parent: Option<usize>,
    /// Index of the inner state that it begins in, and what computes that one's arguments; `None` if no state lies in it.
    pub initial: Option<(usize, Block)>,
    /// What it does when it is entered, before anything else: sets its memory.
    pub entry: Block,
    /// What it does every tick.
    pub body: Block,
    /// What it does when it is left.
    pub exit: Block,
    /// Its transitions in the order in which they are tried.
    pub transitions: Vec<Transition>,
    /// Where it is left to when the machine cannot go on in it: its command is not finite, or a tick wants too many
    /// transitions.
    pub fallback: Option<Target>,
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
        /// Computes the condition, behind the guard of the transition that is tried before.
        code: Block,
        /// Where the condition is afterwards.
        truth: Register,
        /// For how long it must have held without a break (register of a time in s), and the timer that watches.
        lasting: Option<(Register, usize)>,
    },
    /// When the state has been active for a time.
    After {
        /// Computes the time, behind the guard of the transition that is tried before.
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

/// The code of the guards of a list of transitions. One lies behind the other, so that a tick runs them in one go.
#[inline]
pub(super) fn guards(transitions: &[Transition]) -> Block {
    match transitions {
        [] => 0..0,
        [first, .., last] => first.guard.code().start..last.guard.code().end,
        [only] => only.guard.code().clone(),
    }
}

/// Where a transition leads.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Target {
    /// Into a state.
    State {
        /// Its index.
        state: usize,
        /// Computes the arguments, of outer states that are entered with it too, and puts them where the states read them.
        arguments: Block,
        /// Whether it goes on in the inner state that was active last, if there was one, and not in its initial one.
        resume: bool,
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
    pub fn code(&self) -> &Block {
        match self {
            Self::When { code, .. } | Self::After { code, .. } => code,
        }
    }
}

impl Program {
    /// Where the state with this index is left to when the machine cannot go on in it: by its own failsafe, or else by the
    /// machine's, given with the state that it belongs to.
    #[must_use]
    pub fn fallback_of(&self, state: usize) -> Option<(Option<usize>, &Target)> {
        let own = |state: usize| Some((Some(state), self.states[state].fallback.as_ref()?));
        self.outward(state).find_map(own).or_else(|| Some((None, self.fallback.as_ref()?)))
    }

    /// The most operations that a tick in the state with this index does without leaving it: all guards, and what the machine and
    /// the state do, with those of its outer states. Jumps only lead forward, so that a block never does more operations than it has.
    #[must_use]
    pub fn operations(&self, state: usize) -> usize {
        let guards = |transitions: &[Transition]| guards(transitions).len();
        let active = self.outward(state).map(|state| &self.states[state]);
        let own = guards(&self.always) + self.body.len();
        own + active.map(|state| guards(&state.transitions) + state.body.len()).sum::<usize>()
    }

    /// A bound on the operations of any tick: what a run begins with, eight transitions, each with the most that one can do, guards before and behind
    /// each, a failsafe, and what the machine and the states do.
    #[must_use]
    pub fn most_operations(&self) -> usize {
        let most = |of: &dyn Fn(usize) -> usize| (0..self.states.len()).map(of).max().unwrap_or(0);
        let along_path = |state: usize, of: &dyn Fn(&State) -> usize| -> usize {
            self.outward(state).map(|state| of(&self.states[state])).sum()
        };
        let guards = |transitions: &[Transition]| guards(transitions).len();
        let values = |target: &Target| if let Target::State { arguments, .. } = target { arguments.len() } else { 0 };
        let of_states =
            self.states.iter().flat_map(|state| state.transitions.iter().map(|one| &one.target).chain(&state.fallback));
        let targets = self.always.iter().map(|one| &one.target).chain(&self.fallback).chain(of_states);
        let entering = |state: &State| state.entry.len() + state.initial.as_ref().map_or(0, |(_, values)| values.len());
        let transition = most(&|state| along_path(state, &|state| state.exit.len()))
            + targets.map(values).max().unwrap_or(0)
            + most(&|state| along_path(state, &entering));
        let look = most(&|state| along_path(state, &|state| guards(&state.transitions)));
        let act = most(&|state| along_path(state, &|state| state.body.len()));
        let once = self.start.len() + self.entry.len() + guards(&self.always) + self.body.len();
        once + (MICROSTEP_LIMIT + 1) * (look + transition) + 2 * act
    }

    /// Bytes that a running machine keeps: registers, times, and which state was last active in which.
    #[must_use]
    pub fn memory_bytes(&self) -> usize {
        let (number, index, time) = (size_of::<f64>(), size_of::<Option<usize>>(), size_of::<Option<f64>>());
        self.initial_registers.len() * number + self.states.len() * (number + index) + self.timers * time
    }

    /// The state with this index and those that it lies in, the innermost first.
    pub fn outward(&self, state: usize) -> impl Iterator<Item = usize> {
        std::iter::successors(Some(state), |&state| self.states[state].parent)
    }

    /// Whether the state `inner` is the state `outer` or lies in it.
    #[must_use]
    pub fn contains(&self, outer: usize, inner: usize) -> bool {
        self.outward(inner).any(|state| state == outer)
    }

    /// The innermost of the states that stay active when a transition of the state `from`, or of any state, leads to `target`:
    /// it contains both, and is not the target.
    #[must_use]
    pub fn common_ancestor(&self, from: Option<usize>, target: usize) -> Option<usize> {
        let from = from?;
        self.outward(target).skip(1).find(|&outer| self.contains(outer, from))
    }

    /// Whether a transition of the state `from`, or of any state, has led where it leads already while the innermost active
    /// state is `active`: it stands outside of its target, and that is active.
    #[must_use]
    pub fn is_target_active(&self, from: Option<usize>, target: usize, active: usize) -> bool {
        let from_outside = from.is_none_or(|from| from != target && self.contains(from, target));
        from_outside && self.contains(target, active)
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
        parameter.check(value, dimension)?;
        self.initial_registers[index] = value;
        Ok(())
    }
}

impl Parameter {
    /// Whether it can be set to `value` (SI), which has the dimension `dimension`.
    ///
    /// # Errors
    /// [`SetError`] when its dimension or range is another, or the value is not finite.
    pub fn check(&self, value: f64, dimension: Dimension) -> Result<(), SetError> {
        let name = self.name.clone();
        if self.dimension != dimension {
            let (expected, found) = (self.dimension.to_string(), dimension.to_string());
            return Err(SetError::Dimension { name, expected, found });
        }
        if !value.is_finite() {
            return Err(SetError::NotFinite { name });
        }
        match self.range {
            Some((low, high)) if !(low..=high).contains(&value) => {
                let [value, low, high] = [value, low, high].map(|value| format_si(value, dimension));
                Err(SetError::Range { name, value, low, high })
            }
            _ => Ok(()),
        }
    }
}
