//! The compiled program of a policy.

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::units::Dimension;

use super::contact_estimator_kind::ContactEstimatorKind;
use super::contour::{Keypoints, PositionContour};
use super::contract::{Contract, Moment};
use super::needs::Needs;
use super::observer::ContractId;
use super::op::{Block, Op, Register};
use super::output::Outputs;
use super::parameter::{Parameter, ParameterValue, SetError};
use super::tick::MICROSTEP_LIMIT;

/// Maximum number of operations of a program.
pub const CODE_LIMIT: usize = 50_000;
/// Maximum number of registers of a program.
pub const REGISTER_LIMIT: usize = 60_000;
/// Maximum nesting depth of states. It bounds the work of a tick.
pub const NESTING_LIMIT: usize = 8;

/// Maximum number of contours through positions.
pub const CONTOUR_LIMIT: usize = 8;

/// A compiled policy.
///
/// The registers contain first the parameters, then constants, arguments of states and temporaries, as the compiler
/// arranges them. [`Program::initial_registers`] are their values at the start of a run. A program from another source
/// than the compiler or an [`Artifact`](super::Artifact) is safe to run if it passes [`Program::verify`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Program {
    /// Name of the machine.
    pub name: String,
    /// Names of the whiskers that the policy binds, as in the rig.
    pub whiskers: Vec<String>,
    /// The contact estimator of each whisker.
    pub contact_estimators: Vec<ContactEstimatorKind>,
    /// True for each whisker that a rig may lack.
    pub optional: Vec<bool>,
    /// Keypoints of the contours of all whiskers.
    pub keypoints: Keypoints,
    /// Contours through positions that the policy records.
    pub contours: Vec<PositionContour>,
    /// Rates of the loop and age of samples that the policy needs.
    pub needs: Needs,
    /// The parameters. The parameter with index `i` is in register `i`.
    pub parameters: Vec<Parameter>,
    /// The states. An outer state comes before its inner states.
    pub states: Vec<State>,
    /// Index of the initial state.
    pub initial: usize,
    /// Code that runs once at the start of a run. It computes values that depend only on parameters and constants.
    pub start: Block,
    /// Code that runs once after `start` and before a state is entered. It initialises the memory of the machine.
    pub entry: Block,
    /// Code that runs first in every tick, before transitions are tried. It only changes memory.
    pub monitors: Block,
    /// Code that runs in every tick before the bodies of the active states.
    pub body: Block,
    /// Global transitions. They are tried first in every state.
    pub always: Vec<Transition>,
    /// Contracts of the whole machine.
    pub contracts: Vec<Contract>,
    /// Fallback transition for states without their own.
    pub fallback: Option<Target>,
    /// What the policy plots and logs.
    pub outputs: Outputs,
    /// All code. Blocks are ranges of it.
    pub code: Vec<Op>,
    /// Values of the registers at the start of a run.
    pub initial_registers: Vec<f64>,
    /// Number of timers for guards with a duration. Those of `always` come first.
    pub timers: usize,
}

/// A state of a program.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct State {
    /// Name of the state.
    pub name: Arc<str>,
    /// Index of the outer state. It is less than the index of this state.
    pub parent: Option<usize>,
    /// Index of the initial inner state, and the code that computes its arguments. `None` for a state without inner
    /// states.
    pub initial: Option<(usize, Block)>,
    /// Code that runs first when the state is entered. It initialises the state's memory.
    pub entry: Block,
    /// Code that runs in every tick.
    pub body: Block,
    /// Code that runs when the state is left.
    pub exit: Block,
    /// Transitions in the order in which they are tried.
    pub transitions: Vec<Transition>,
    /// Contracts of the state.
    pub contracts: Vec<Contract>,
    /// Fallback transition: taken if the action is not finite or a tick exceeds the microstep limit.
    pub fallback: Option<Target>,
}

/// A transition of a state, or a global one.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Transition {
    /// The condition.
    pub guard: Guard,
    /// The target.
    pub target: Target,
}

/// The condition under which a transition is taken.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Guard {
    /// A condition holds.
    When {
        /// Code of the condition. It follows the code of the previous guard.
        code: Block,
        /// Register of the result.
        truth: Register,
        /// Register of the duration (s) for which the condition must hold without interruption, and the timer that
        /// measures it.
        lasting: Option<(Register, usize)>,
    },
    /// The state has been active for a time.
    After {
        /// Code of the time. It follows the code of the previous guard.
        code: Block,
        /// Register of the result (s).
        time: Register,
    },
}

impl Guard {
    /// True if the guard needs a timer.
    #[must_use]
    pub fn is_timed(&self) -> bool {
        matches!(self, Self::When { lasting: Some(_), .. })
    }
}

/// The code of the guards of a list of transitions. It is contiguous, so that a tick evaluates all of them in one run.
#[inline]
pub(super) fn guards(transitions: &[Transition]) -> Block {
    match transitions {
        [] => 0..0,
        [first, .., last] => first.guard.code().start..last.guard.code().end,
        [only] => only.guard.code().clone(),
    }
}

/// Number of operations of the contracts that are evaluated at a moment.
fn contract_operations(contracts: &[Contract], moment: Moment) -> usize {
    contracts.iter().filter(|contract| contract.moment == moment).map(|contract| contract.code.len()).sum()
}

/// The target of a transition.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Target {
    /// A state is entered.
    State {
        /// Index of the state.
        state: usize,
        /// Code that computes the arguments of all entered states and writes them to their registers.
        arguments: Block,
        /// True if the last active inner state is entered (history), false for the initial one.
        resume: bool,
    },
    /// The run ends as a failure for this reason.
    Failure(Arc<str>),
    /// The run ends as a success for this reason.
    Success(Arc<str>),
}

impl Guard {
    /// The code of the guard.
    #[must_use]
    pub fn code(&self) -> &Block {
        match self {
            Self::When { code, .. } | Self::After { code, .. } => code,
        }
    }
}

/// A program that can only run in a simulator.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error(
    "the policy uses the contact estimator truth for whisker `{whisker}`, which only a simulator has; write another one after \
     `by`, such as sliding, and compile the policy again"
)]
pub struct OnlySimulated {
    /// The first whisker with that estimator.
    pub whisker: String,
}

impl Program {
    /// The name of a whisker, or of a contour through positions, by its [index](super::Senses).
    #[must_use]
    pub fn contour_name(&self, index: usize) -> Option<&str> {
        match index.checked_sub(self.whiskers.len()) {
            None => self.whiskers.get(index).map(String::as_str),
            Some(index) => self.contours.get(index).map(|contour| contour.name.as_str()),
        }
    }

    /// True if a contact estimator needs [true tips](crate::signal::TrueTip), which only a simulator has.
    #[must_use]
    pub fn uses_true_tips(&self) -> bool {
        self.contact_estimators.iter().any(|kind| kind.is_ideal())
    }

    /// Checks that the program can run outside of a simulator.
    ///
    /// # Errors
    /// [`OnlySimulated`] with the first whisker that needs a true tip.
    pub fn check_for_robot(&self) -> Result<(), OnlySimulated> {
        match self.whiskers.iter().zip(&self.contact_estimators).find(|(_, kind)| kind.is_ideal()) {
            Some((whisker, _)) => Err(OnlySimulated { whisker: whisker.clone() }),
            None => Ok(()),
        }
    }

    /// The fallback transition for a state, and the state to which it belongs. It is the transition of the state
    /// itself, of the nearest outer state, or else of the program (`None`).
    #[must_use]
    pub fn fallback_of(&self, state: usize) -> Option<(Option<usize>, &Target)> {
        let own = |state: usize| Some((Some(state), self.states[state].fallback.as_ref()?));
        self.outward(state).find_map(own).or_else(|| Some((None, self.fallback.as_ref()?)))
    }

    /// Maximum number of operations of a tick that stays in a state: the monitors, and all guards, contracts and bodies of the
    /// program, the state and its outer states. Jumps only go forward, so a block never runs more operations than it contains.
    #[must_use]
    pub fn operations(&self, state: usize) -> usize {
        let guards = |transitions: &[Transition]| guards(transitions).len();
        let watched = |contracts: &[Contract]| contract_operations(contracts, Moment::Tick);
        let active = self.outward(state).map(|state| &self.states[state]);
        let own = self.monitors.len() + guards(&self.always) + watched(&self.contracts) + self.body.len();
        own + active
            .map(|state| guards(&state.transitions) + watched(&state.contracts) + state.body.len())
            .sum::<usize>()
    }

    /// True if the policy uses a map. The control loop then has one.
    #[must_use]
    pub fn uses_map(&self) -> bool {
        self.code.iter().any(|op| op.is_of_map())
    }

    /// Upper bound of the operations of any tick. It includes the start of a run with its initial state, the maximum
    /// number of transitions with all guards, a fallback transition and all bodies.
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
        let entering = |state: &State| {
            state.entry.len()
                + contract_operations(&state.contracts, Moment::Entry)
                + state.initial.as_ref().map_or(0, |(_, values)| values.len())
        };
        let enter = most(&|state| along_path(state, &entering));
        let transition = most(&|state| along_path(state, &|state| state.exit.len()))
            + targets.map(values).max().unwrap_or(0)
            + enter;
        let look = most(&|state| along_path(state, &|state| guards(&state.transitions)));
        let act = most(&|state| along_path(state, &|state| state.body.len()));
        let watch = most(&|state| along_path(state, &|state| contract_operations(&state.contracts, Moment::Tick)));
        let own_contracts = self.contracts.iter().map(|contract| contract.code.len()).sum::<usize>();
        let once = self.start.len() + self.entry.len() + self.monitors.len() + enter;
        let once = once + guards(&self.always) + self.body.len() + own_contracts + watch;
        once + (MICROSTEP_LIMIT + 1) * (look + transition) + 2 * act
    }

    /// Bytes of memory of a running machine: registers, times and last active inner states.
    #[must_use]
    pub fn memory_bytes(&self) -> usize {
        let (number, index, time) = (size_of::<f64>(), size_of::<Option<usize>>(), size_of::<Option<f64>>());
        self.initial_registers.len() * number + self.states.len() * (number + index) + self.timers * time
    }

    /// The state and all its outer states, the innermost first.
    pub fn outward(&self, state: usize) -> impl Iterator<Item = usize> {
        std::iter::successors(Some(state), |&state| self.states[state].parent)
    }

    /// True if `inner` is `outer` or one of its inner states.
    #[must_use]
    pub fn contains(&self, outer: usize, inner: usize) -> bool {
        self.outward(inner).any(|state| state == outer)
    }

    /// The innermost state that stays active in a transition of the state `from` to `target`. It contains both and is
    /// not the target. `None` for a global transition.
    #[must_use]
    pub fn common_ancestor(&self, from: Option<usize>, target: usize) -> Option<usize> {
        let from = from?;
        self.outward(target).skip(1).find(|&outer| self.contains(outer, from))
    }

    /// True if a transition would enter a target that is already active, and its own state is outside of the target.
    /// `active` is the innermost active state, and `from` is `None` for a global transition.
    #[must_use]
    pub fn is_target_active(&self, from: Option<usize>, target: usize, active: usize) -> bool {
        let from_outside = from.is_none_or(|from| from != target && self.contains(from, target));
        from_outside && self.contains(target, active)
    }

    /// Sets the parameter `name` to `value` (SI) of the given dimension.
    ///
    /// # Errors
    /// [`SetError`] if there is no such parameter, the dimension differs, or the value is out of range or not finite.
    pub fn set(&mut self, name: &str, value: f64, dimension: Dimension) -> Result<(), SetError> {
        let index = self.parameter(name)?;
        self.parameters[index].check(value, dimension)?;
        self.initial_registers[index] = value;
        Ok(())
    }

    /// Sets the parameter `name` to a value as a user writes it. Returns the value (SI), for a choice its number.
    ///
    /// # Errors
    /// [`SetError`] if there is no such parameter, or it does not allow the value.
    pub fn set_value(&mut self, name: &str, value: &ParameterValue) -> Result<f64, SetError> {
        let index = self.parameter(name)?;
        let value = self.parameters[index].read(value)?;
        self.initial_registers[index] = value;
        Ok(value)
    }

    /// The state and the contract with an identifier.
    #[must_use]
    pub fn contract(&self, id: ContractId) -> Option<(Option<&State>, &Contract)> {
        let Some(state) = id.state else { return Some((None, self.contracts.get(id.index)?)) };
        let state = self.states.get(state)?;
        Some((Some(state), state.contracts.get(id.index)?))
    }

    /// Index of a parameter.
    fn parameter(&self, name: &str) -> Result<usize, SetError> {
        self.parameters.iter().position(|parameter| parameter.name == name).ok_or_else(|| {
            let known = self.parameters.iter().map(|parameter| format!("`{}`", parameter.name)).collect::<Vec<_>>();
            let known = if known.is_empty() { "none".to_owned() } else { known.join(", ") };
            SetError::Unknown { name: name.to_owned(), known }
        })
    }
}
