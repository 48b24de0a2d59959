//! A machine at work: memory, transitions, one action a tick.

use std::sync::Arc;

use super::action::Action;
use super::evaluate::evaluate;
use super::failsafe::{Cause, Failsafe};
use super::op::Block;
use super::program::{Guard, Program, Target, Transition};
use super::senses::Senses;

/// The most transitions that one tick takes; a policy that wants more fails.
pub const CHAIN_LIMIT: usize = 8;

/// Slack (s) with which times are compared, so that ten ticks of a thirtieth of a second make a third.
pub(crate) const TIME_SLACK: f64 = 1e-9;

/// A running machine: a program and its memory.
#[derive(Debug, Clone)]
pub struct Machine {
    program: Arc<Program>,
    registers: Vec<f64>,
    state: usize,
    entered_at: Option<f64>,
    /// For every guard with a duration, since when its condition has held.
    holding_since: Vec<Option<f64>>,
    /// How many timers, at the front, belong to the rules that hold always and outlive a transition.
    lasting_timers: usize,
    failure: Option<Failure>,
}

/// Why a machine has failed.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum Failure {
    /// The policy went to `Failure` and gave this reason.
    #[error("{0}")]
    Policy(Arc<str>),
    /// A command was not a finite number.
    #[error("state {state} gave a command that is not a finite number")]
    NotFinite {
        /// The state that gave it.
        state: Arc<str>,
    },
    /// One tick took more than [`CHAIN_LIMIT`] transitions.
    #[error("more than {CHAIN_LIMIT} transitions in one tick, the last one taken into {state}")]
    Chain {
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
    pub failsafe: Option<Failsafe>,
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
        Self {
            registers: program.image.clone(),
            state: program.initial,
            entered_at: None,
            holding_since: vec![None; program.timers],
            lasting_timers: program.always.iter().filter(|rule| rule.guard.is_timed()).count(),
            failure: None,
            program,
        }
    }

    /// A machine that has just entered a state, with `registers` as its memory.
    pub(crate) fn entered(program: Arc<Program>, state: usize, registers: Vec<f64>) -> Self {
        Self { registers, state, ..Self::new(program) }
    }

    /// The program that it runs.
    #[must_use]
    pub fn program(&self) -> &Program {
        &self.program
    }

    /// Index of the active state.
    #[must_use]
    pub fn state(&self) -> usize {
        self.state
    }

    /// Name of the active state, `Failure` after a failure.
    #[must_use]
    pub fn state_name(&self) -> &str {
        if self.failure.is_some() { "Failure" } else { &self.program.states[self.state].name }
    }

    /// Why the machine has failed, if it has.
    #[must_use]
    pub fn failure(&self) -> Option<&Failure> {
        self.failure.as_ref()
    }

    /// One tick: first the rules that hold always, then the active state's transitions in their written order (and those of
    /// the state entered, up to [`CHAIN_LIMIT`]), then what the active state does.
    ///
    /// An action with a number that is not finite is never given. Instead, and where a tick wants too many transitions, the
    /// active state is left by its failsafe, or else by the program's, and what the state entered does counts; without a
    /// failsafe, or if that state's action is not finite either, the machine fails.
    pub fn tick<S: Senses>(&mut self, senses: &mut S) -> Tick {
        if self.failure.is_some() {
            return Tick { action: Action::Stop, status: Status::Failed, failsafe: None };
        }
        let program = Arc::clone(&self.program);
        let now = senses.time();
        if self.entered_at.is_none() {
            self.enter(&program, self.state, now, senses);
        }

        let mut target = self.due(&program, &program.always, now, senses);
        for taken in 0..=CHAIN_LIMIT {
            target = target.or_else(|| self.due(&program, &program.states[self.state].transitions, now, senses));
            match target.take() {
                None => return self.act(&program, now, senses),
                Some(Target::Failure(reason)) => return self.fail(Failure::Policy(Arc::clone(reason))),
                Some(Target::State { state, arguments }) if taken < CHAIN_LIMIT => {
                    self.take(&program, *state, arguments, now, senses);
                }
                Some(Target::State { .. }) => {}
            }
        }
        self.leave(&program, Cause::Chain, now, senses)
    }

    /// Goes from the active state to another.
    fn take<S: Senses>(&mut self, program: &Program, state: usize, arguments: &Block, now: f64, senses: &mut S) {
        evaluate(&program.code, &program.states[self.state].exit, &mut self.registers, senses);
        evaluate(&program.code, arguments, &mut self.registers, senses);
        self.enter(program, state, now, senses);
    }

    fn enter<S: Senses>(&mut self, program: &Program, state: usize, now: f64, senses: &mut S) {
        self.state = state;
        self.entered_at = Some(now);
        self.holding_since[self.lasting_timers..].fill(None);
        evaluate(&program.code, &program.states[state].entry, &mut self.registers, senses);
    }

    fn act<S: Senses>(&mut self, program: &Program, now: f64, senses: &mut S) -> Tick {
        match self.action(program, senses) {
            Some(action) => Tick { action, status: Status::Running, failsafe: None },
            None => self.leave(program, Cause::NotFinite, now, senses),
        }
    }

    /// What the active state does; `None` if it is not finite.
    fn action<S: Senses>(&mut self, program: &Program, senses: &mut S) -> Option<Action> {
        let body = &program.states[self.state].body;
        let action = evaluate(&program.code, body, &mut self.registers, senses).unwrap_or(Action::Hold);
        action.is_finite().then_some(action)
    }

    /// Leaves the active state, in which the machine cannot go on, by the failsafe. The state entered only acts: whatever it
    /// would do next has time until the next tick.
    fn leave<S: Senses>(&mut self, program: &Program, cause: Cause, now: f64, senses: &mut S) -> Tick {
        let left = self.state;
        let tick = match program.failsafe_of(left) {
            None => return self.fail(cause.failure(&program.states[left].name)),
            Some(Target::Failure(reason)) => self.fail(Failure::Policy(Arc::clone(reason))),
            Some(Target::State { state, arguments }) => {
                self.take(program, *state, arguments, now, senses);
                match self.action(program, senses) {
                    Some(action) => Tick { action, status: Status::Running, failsafe: None },
                    None => self.fail(Cause::NotFinite.failure(&program.states[*state].name)),
                }
            }
        };
        Tick { failsafe: Some(Failsafe { left, cause }), ..tick }
    }

    fn fail(&mut self, failure: Failure) -> Tick {
        self.failure = Some(failure);
        Tick { action: Action::Stop, status: Status::Failed, failsafe: None }
    }

    /// The target of the first transition that is due. Every guard is looked at, so that the timers of the later ones run.
    fn due<'p, S: Senses>(
        &mut self,
        program: &'p Program,
        transitions: &'p [Transition],
        now: f64,
        senses: &mut S,
    ) -> Option<&'p Target> {
        let mut first = None;
        for transition in transitions {
            if self.holds(program, &transition.guard, now, senses) && first.is_none() {
                first = Some(&transition.target);
            }
        }
        first
    }

    fn holds<S: Senses>(&mut self, program: &Program, guard: &Guard, now: f64, senses: &mut S) -> bool {
        match guard {
            Guard::When { code, truth, lasting } => {
                evaluate(&program.code, code, &mut self.registers, senses);
                let holds = self.registers[usize::from(*truth)] > 0.5;
                let Some((duration, timer)) = lasting else { return holds };
                let since = &mut self.holding_since[*timer];
                if !holds {
                    *since = None;
                    return false;
                }
                now - *since.get_or_insert(now) >= self.registers[usize::from(*duration)] - TIME_SLACK
            }
            Guard::After { code, time } => {
                evaluate(&program.code, code, &mut self.registers, senses);
                let active = now - self.entered_at.unwrap_or(now);
                active >= self.registers[usize::from(*time)] - TIME_SLACK
            }
        }
    }
}
