//! The execution of a machine: one action per tick.

use std::sync::Arc;

use super::action::{Action, NonFinite};
use super::activity::Activity;
use super::contract::ObservedContract;
use super::fallback::Fallback;
use super::observer::Observer;
use super::output::LoggedMessage;
use super::program::Program;
use super::senses::Senses;

/// Maximum number of transitions in one tick (microsteps). A policy that exceeds it fails or takes its fallback
/// transition.
pub const MICROSTEP_LIMIT: usize = 8;

/// A running machine: a program and its state of execution.
#[derive(Debug, Clone)]
pub struct Machine {
    program: Arc<Program>,
    activity: Activity,
    end: Option<End>,
}

/// The failure of a machine.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum Failure {
    /// The policy took a transition to `Failure` with this reason.
    #[error("{0}")]
    Policy(Arc<str>),
    /// A number of an action was not finite.
    #[error("state {state} gave a command that is not finite: {non_finite}")]
    NotFinite {
        /// The state that gave the action.
        state: Arc<str>,
        /// The number.
        non_finite: NonFinite,
    },
    /// A transition was enabled after [`MICROSTEP_LIMIT`] transitions in one tick.
    #[error("more than {MICROSTEP_LIMIT} transitions in one tick, the last one taken into {state}")]
    MicrostepLimit {
        /// The innermost state after these transitions.
        state: Arc<str>,
    },
}

/// The end of a run by the machine.
#[derive(Debug, Clone)]
pub(super) enum End {
    /// The machine has failed.
    Failure(Failure),
    /// The policy took a transition to `Success` with this reason.
    Success(Arc<str>),
}

/// The result of a tick.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tick {
    /// The action for the platform.
    pub action: Action,
    /// The status of the machine after the tick.
    pub status: Status,
    /// The fallback transition that was taken, if any.
    pub fallback: Option<Fallback>,
}

/// The status of a machine.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Status {
    /// The machine runs.
    Running,
    /// The machine has failed for the reason given by [`Machine::failure`]. It stops for the rest of the run.
    Failed,
    /// The machine has succeeded for the reason given by [`Machine::success`]. It stops for the rest of the run.
    Succeeded,
}

impl Machine {
    /// Creates a machine at the start of `program`.
    #[must_use]
    pub fn new(program: Arc<Program>) -> Self {
        let activity = Activity::new(&program, program.initial, program.initial_registers.clone());
        Self { activity, end: None, program }
    }

    /// Creates a machine that is about to enter a state, with the given registers.
    #[must_use]
    pub fn entering(program: Arc<Program>, state: usize, registers: Vec<f64>) -> Self {
        Self { activity: Activity::new(&program, state, registers), end: None, program }
    }

    /// Continues with another program of the same policy. It may have other values of parameters, further registers after the
    /// existing ones, and operations that read these. Active states, memory and times stay as they are.
    pub fn continue_with<S: Senses>(&mut self, program: Arc<Program>, senses: &mut S) {
        self.activity.continue_with(&program, senses);
        self.program = program;
    }

    /// The program of the machine.
    #[must_use]
    pub fn program(&self) -> &Program {
        &self.program
    }

    /// Index of the innermost active state.
    #[must_use]
    pub fn state(&self) -> usize {
        self.activity.state()
    }

    /// Name of the innermost active state, or `Failure` or `Success` after the end.
    #[must_use]
    pub fn state_name(&self) -> &str {
        match self.end {
            None => &self.program.states[self.state()].name,
            Some(End::Failure(_)) => "Failure",
            Some(End::Success(_)) => "Success",
        }
    }

    /// The reason of the failure, if the machine has failed.
    #[must_use]
    pub fn failure(&self) -> Option<&Failure> {
        if let Some(End::Failure(failure)) = &self.end { Some(failure) } else { None }
    }

    /// The reason of the success, if the machine has succeeded.
    #[must_use]
    pub fn success(&self) -> Option<&str> {
        if let Some(End::Success(reason)) = &self.end { Some(reason) } else { None }
    }

    /// The contracts of the machine and of its states, with what was observed so far.
    pub fn contracts(&self) -> impl Iterator<Item = ObservedContract<'_>> {
        self.activity.contracts(&self.program)
    }

    /// The plots that the newest tick has set, by their index in the program, with their values (SI).
    pub fn plotted(&self) -> impl Iterator<Item = (usize, f64)> {
        self.activity.plotted(&self.program)
    }

    /// The messages that the newest tick has logged, in their order.
    pub fn logged(&self) -> impl Iterator<Item = LoggedMessage> {
        self.activity.logged(&self.program)
    }

    /// The status after the newest tick.
    fn status(&self) -> Status {
        match self.end {
            None => Status::Running,
            Some(End::Failure(_)) => Status::Failed,
            Some(End::Success(_)) => Status::Succeeded,
        }
    }

    /// Executes one tick. The monitors run first. Then it tries the global transitions, and then those of the active states, from the
    /// outermost to the innermost and in their written order. After each one taken it tries again, up to
    /// [`MICROSTEP_LIMIT`] times. Then the contracts are evaluated. Then the body of the program runs, and the bodies of the active states, from the
    /// outermost to the innermost.
    ///
    /// A non-finite action is never returned. In that case, or if the tick exceeds the microstep limit, the fallback
    /// transition of the state is taken, or else that of the program. The entered state then gives the action. The
    /// machine fails if there is no fallback transition or the new action is not finite either.
    pub fn tick<S: Senses>(&mut self, senses: &mut S) -> Tick {
        self.tick_observed(senses, &mut ())
    }

    /// Executes one [`tick`](Self::tick). `observer` receives the guards that are tried and the transitions that are taken.
    pub fn tick_observed<S: Senses>(&mut self, senses: &mut S, observer: &mut (impl Observer + ?Sized)) -> Tick {
        if self.end.is_some() {
            self.activity.show_nothing(&self.program);
            return Tick { action: Action::Stop, status: self.status(), fallback: None };
        }
        let mut tick = Tick { action: Action::Hold, status: Status::Running, fallback: None };
        let (outcome, fallback) = self.activity.tick(&self.program, senses, &mut tick.action, observer);
        tick.fallback = fallback;
        if let Err(end) = outcome {
            self.end = Some(end);
            tick.action = Action::Stop;
            tick.status = self.status();
        }
        tick
    }
}
