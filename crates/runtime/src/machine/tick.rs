//! A machine at work: memory, transitions, one action a tick.

use std::sync::Arc;

use super::action::{Action, NonFinite};
use super::activity::Activity;
use super::fallback::Fallback;
use super::program::Program;
use super::senses::Senses;

/// The most transitions that one tick takes; a policy that wants more fails.
pub const MICROSTEP_LIMIT: usize = 8;

/// A running machine: a program and its memory.
#[derive(Debug, Clone)]
pub struct Machine {
    program: Arc<Program>,
    activity: Activity,
    failure: Option<Failure>,
}

/// Why a machine has failed.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum Failure {
    /// The policy went to `Failure` and gave this reason.
    #[error("{0}")]
    Policy(Arc<str>),
    /// A number of a command was not finite.
    #[error("state {state} gave a command that is not finite: {non_finite}")]
    NotFinite {
        /// The state that gave it.
        state: Arc<str>,
        /// The number.
        non_finite: NonFinite,
    },
    /// One tick took more than [`MICROSTEP_LIMIT`] transitions.
    #[error("more than {MICROSTEP_LIMIT} transitions in one tick, the last one taken into {state}")]
    MicrostepLimit {
        /// The state that the last one taken led into.
        state: Arc<str>,
    },
}

/// What a tick gave.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tick {
    /// What the platform is asked to do.
    pub action: Action,
    /// Whether the machine goes on.
    pub status: Status,
    /// The state that was left by its failsafe, if one was.
    pub fallback: Option<Fallback>,
}

/// Whether a machine goes on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Status {
    /// It goes on.
    Running,
    /// It has failed, for the reason that [`Machine::failure`] gives, and stands still for good.
    Failed,
}

impl Machine {
    /// A machine at the start of `program`.
    #[must_use]
    pub fn new(program: Arc<Program>) -> Self {
        let activity = Activity::new(&program, program.initial, program.initial_registers.clone());
        Self { activity, failure: None, program }
    }

    /// A machine that is about to enter a state, with `registers` as its memory.
    pub fn entering(program: Arc<Program>, state: usize, registers: Vec<f64>) -> Self {
        Self { activity: Activity::new(&program, state, registers), failure: None, program }
    }

    /// The program that it runs.
    #[must_use]
    pub fn program(&self) -> &Program {
        &self.program
    }

    /// Index of the active state, the innermost one.
    #[must_use]
    pub fn state(&self) -> usize {
        self.activity.state()
    }

    /// Name of the active state, the innermost one; `Failure` after a failure.
    #[must_use]
    pub fn state_name(&self) -> &str {
        if self.failure.is_some() { "Failure" } else { &self.program.states[self.state()].name }
    }

    /// Why the machine has failed, if it has.
    #[must_use]
    pub fn failure(&self) -> Option<&Failure> {
        self.failure.as_ref()
    }

    /// One tick: first the rules that hold always, then the active states' transitions, from the outermost state to the
    /// innermost and in their written order (and again after each one taken, up to [`MICROSTEP_LIMIT`]), then what the machine
    /// itself does, and what the active states do, from the outermost to the innermost.
    ///
    /// An action with a number that is not finite is never given. Instead, and where a tick wants too many transitions, the
    /// active state is left by its failsafe, or else by the program's, and what the state entered does counts; without a
    /// failsafe, or if that state's action is not finite either, the machine fails.
    pub fn tick<S: Senses>(&mut self, senses: &mut S) -> Tick {
        if self.failure.is_some() {
            return Tick { action: Action::Stop, status: Status::Failed, fallback: None };
        }
        let mut tick = Tick { action: Action::Hold, status: Status::Running, fallback: None };
        let (went, fallback) = self.activity.tick(&self.program, senses, &mut tick.action);
        tick.fallback = fallback;
        if let Err(failure) = went {
            self.failure = Some(failure);
            tick.action = Action::Stop;
            tick.status = Status::Failed;
        }
        tick
    }
}
