//! A machine at work: memory, transitions, one action a tick.

use std::sync::Arc;

use super::action::Action;
use super::evaluate::evaluate;
use super::failsafe::{Cause, Failsafe};
use super::op::Block;
use super::program::{Guard, NESTING_LIMIT, Program, Target, Transition};
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
    /// The innermost active state; those that it lies in are active too.
    state: usize,
    has_begun: bool,
    /// When each state was entered last (s).
    entered_at: Vec<f64>,
    /// For every state, which of the states directly in it was active last.
    last_inner: Vec<Option<usize>>,
    /// For every guard with a duration, since when its condition has held.
    holding_since: Vec<Option<f64>>,
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
            has_begun: false,
            entered_at: vec![0.0; program.states.len()],
            last_inner: vec![None; program.states.len()],
            holding_since: vec![None; program.timers],
            failure: None,
            program,
        }
    }

    /// A machine that is about to enter a state, with `registers` as its memory.
    pub(crate) fn entering(program: Arc<Program>, state: usize, registers: Vec<f64>) -> Self {
        Self { registers, state, ..Self::new(program) }
    }

    /// The program that it runs.
    #[must_use]
    pub fn program(&self) -> &Program {
        &self.program
    }

    /// Index of the active state, the innermost one.
    #[must_use]
    pub fn state(&self) -> usize {
        self.state
    }

    /// Name of the active state, the innermost one; `Failure` after a failure.
    #[must_use]
    pub fn state_name(&self) -> &str {
        if self.failure.is_some() { "Failure" } else { &self.program.states[self.state].name }
    }

    /// Why the machine has failed, if it has.
    #[must_use]
    pub fn failure(&self) -> Option<&Failure> {
        self.failure.as_ref()
    }

    /// One tick: first the rules that hold always, then the active states' transitions, from the outermost state to the
    /// innermost and in their written order (and again after each one taken, up to [`CHAIN_LIMIT`]), then what the active
    /// states do, from the outermost to the innermost.
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
        if !self.has_begun {
            self.has_begun = true;
            self.enter(&program, None, self.state, false, now, senses);
        }

        let mut due = self.due(&program, None, now, senses);
        for taken in 0..=CHAIN_LIMIT {
            let way = Way::to(&program, self.state);
            due = due.or_else(|| way.states().find_map(|state| self.due(&program, Some(state), now, senses)));
            match due.take() {
                None => return self.act(&program, now, senses),
                Some((_, Target::Failure(reason))) => return self.fail(Failure::Policy(Arc::clone(reason))),
                Some((from, Target::State { state, arguments, resume })) if taken < CHAIN_LIMIT => {
                    self.take(&program, from, (*state, arguments, *resume), now, senses);
                }
                Some((_, Target::State { .. })) => {}
            }
        }
        self.leave(&program, (self.state, Cause::Chain), now, senses)
    }

    /// Goes to a target of a state's transition, or of one that belongs to none.
    fn take<S: Senses>(
        &mut self,
        program: &Program,
        from: Option<usize>,
        (target, arguments, resume): (usize, &Block, bool),
        now: f64,
        senses: &mut S,
    ) {
        let stays = program.stays(from, target);
        for left in program.outward(self.state).take_while(|&left| Some(left) != stays) {
            evaluate(&program.code, &program.states[left].exit, &mut self.registers, senses);
        }
        evaluate(&program.code, arguments, &mut self.registers, senses);
        self.enter(program, stays, target, resume, now, senses);
    }

    /// Enters `target` with those of its outer states that do not stay active, then the inner state that it begins in, or
    /// was in last, and so on.
    fn enter<S: Senses>(
        &mut self,
        program: &Program,
        stays: Option<usize>,
        target: usize,
        resume: bool,
        now: f64,
        senses: &mut S,
    ) {
        for state in Way::to(program, target).below(stays) {
            self.enter_one(program, state, now, senses);
        }
        while let Some((initial, arguments)) = &program.states[self.state].initial {
            let inner = match self.last_inner[self.state] {
                Some(last) if resume => last,
                _ => {
                    evaluate(&program.code, arguments, &mut self.registers, senses);
                    *initial
                }
            };
            self.enter_one(program, inner, now, senses);
        }
    }

    fn enter_one<S: Senses>(&mut self, program: &Program, index: usize, now: f64, senses: &mut S) {
        let state = &program.states[index];
        self.state = index;
        self.entered_at[index] = now;
        if let Some(parent) = state.parent {
            self.last_inner[parent] = Some(index);
        }
        for transition in &state.transitions {
            if let Guard::When { lasting: Some((_, timer)), .. } = transition.guard {
                self.holding_since[timer] = None;
            }
        }
        evaluate(&program.code, &state.entry, &mut self.registers, senses);
    }

    fn act<S: Senses>(&mut self, program: &Program, now: f64, senses: &mut S) -> Tick {
        match self.action(program, senses) {
            Ok(action) => Tick { action, status: Status::Running, failsafe: None },
            Err(state) => self.leave(program, (state, Cause::NotFinite), now, senses),
        }
    }

    /// What the active states do: the last action that one of them gives. If it is not finite, the state that gave it.
    fn action<S: Senses>(&mut self, program: &Program, senses: &mut S) -> Result<Action, usize> {
        let mut given = None;
        for state in Way::to(program, self.state).states() {
            let action = evaluate(&program.code, &program.states[state].body, &mut self.registers, senses);
            given = action.map(|action| (state, action)).or(given);
        }
        match given {
            Some((state, action)) if !action.is_finite() => Err(state),
            _ => Ok(given.map_or(Action::Hold, |(_, action)| action)),
        }
    }

    /// Leaves the active state, because of a state in which the machine cannot go on, by the failsafe. The state entered only
    /// acts: whatever it would do next has time until the next tick.
    fn leave<S: Senses>(&mut self, program: &Program, why: (usize, Cause), now: f64, senses: &mut S) -> Tick {
        let (left, (stuck, cause)) = (self.state, why);
        let tick = match program.failsafe_of(left) {
            None => return self.fail(cause.failure(&program.states[stuck].name)),
            Some((_, Target::Failure(reason))) => self.fail(Failure::Policy(Arc::clone(reason))),
            Some((from, Target::State { state, arguments, resume })) => {
                self.take(program, from, (*state, arguments, *resume), now, senses);
                match self.action(program, senses) {
                    Ok(action) => Tick { action, status: Status::Running, failsafe: None },
                    Err(state) => self.fail(Cause::NotFinite.failure(&program.states[state].name)),
                }
            }
        };
        Tick { failsafe: Some(Failsafe { left, cause }), ..tick }
    }

    fn fail(&mut self, failure: Failure) -> Tick {
        self.failure = Some(failure);
        Tick { action: Action::Stop, status: Status::Failed, failsafe: None }
    }

    /// The target of the transition of the state `from`, or of any state, that is due: the first whose guard holds, unless it
    /// has led where it leads already. Every guard is looked at, so that the timers of the later ones run.
    fn due<'p, S: Senses>(
        &mut self,
        program: &'p Program,
        from: Option<usize>,
        now: f64,
        senses: &mut S,
    ) -> Option<(Option<usize>, &'p Target)> {
        let (transitions, since) = match from {
            None => (&program.always, 0.0),
            Some(state) => (&program.states[state].transitions, self.entered_at[state]),
        };
        let mut first: Option<&Transition> = None;
        for transition in transitions {
            if self.holds(program, &transition.guard, now - since, now, senses) {
                first = first.or(Some(transition));
            }
        }
        match &first?.target {
            Target::State { state, .. } if program.is_settled(from, *state, self.state) => None,
            target => Some((from, target)),
        }
    }

    /// Whether a guard holds whose state has been active for the time `active` (s).
    fn holds<S: Senses>(&mut self, program: &Program, guard: &Guard, active: f64, now: f64, senses: &mut S) -> bool {
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
                active >= self.registers[usize::from(*time)] - TIME_SLACK
            }
        }
    }
}

/// The states that are active with one of them, or entered on the way to it.
struct Way {
    /// From the outermost state at `first` to the innermost.
    states: [usize; NESTING_LIMIT],
    first: usize,
}

impl Way {
    fn to(program: &Program, innermost: usize) -> Self {
        let mut way = Self { states: [innermost; NESTING_LIMIT], first: NESTING_LIMIT };
        for state in program.outward(innermost).take(NESTING_LIMIT) {
            way.first -= 1;
            way.states[way.first] = state;
        }
        way
    }

    /// From the outermost to the innermost.
    fn states(&self) -> impl Iterator<Item = usize> + use<'_> {
        self.states[self.first..].iter().copied()
    }

    /// The same, without `outer` and those around it.
    fn below(&self, outer: Option<usize>) -> impl Iterator<Item = usize> + use<'_> {
        let above = self.states().position(|state| Some(state) == outer);
        self.states().skip(above.map_or(0, |above| above + 1))
    }
}
