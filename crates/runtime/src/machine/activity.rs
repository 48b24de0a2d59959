//! The state of execution of a machine: active states, registers and timers.

use std::sync::Arc;

use super::action::{Action, NonFinite};
use super::configuration::Configuration;
use super::contract::{Contract, ContractStatus, Moment, ObservedContract};
use super::evaluate::{compute, evaluate};
use super::fallback::{Cause, Fallback};
use super::observer::{ContractId, Duration, Observer, Standing, TransitionId, TriedGuard, ViolatedContract};
use super::op::Block;
use super::output::LoggedMessage;
use super::program::{Guard, Program, Target, Transition, guards};
use super::senses::Senses;
use super::tick::{End, Failure, MICROSTEP_LIMIT};

/// Tolerance (s) of comparisons of times. With it, ten ticks of 1/30 s are not shorter than 1/3 s.
pub const TIME_SLACK: f64 = 1e-9;

/// The state of execution of a machine. Every method receives the same program.
#[derive(Debug, Clone)]
pub(super) struct Activity {
    /// Values of the registers.
    registers: Vec<f64>,
    /// The active states.
    active: Configuration,
    /// True after the first tick has begun.
    has_begun: bool,
    /// Time at which each state was last entered (s).
    entered_at: Vec<f64>,
    /// For every state, its direct inner state that was active last. History states use it.
    last_inner: Vec<Option<usize>>,
    /// For every guard with a duration, the time (s) since which its condition holds.
    holding_since: Vec<Option<f64>>,
    /// For every contract of the machine and of every state, what was observed.
    contracts: Vec<ContractStatus>,
    contracts_of_states: Vec<Vec<ContractStatus>>,
    /// The count of plots and messages at the start of the newest tick.
    count_before: f64,
}

impl Activity {
    /// Creates the execution of a machine that is about to enter `state`, with the given `registers`.
    pub(super) fn new(program: &Program, state: usize, registers: Vec<f64>) -> Self {
        Self {
            registers,
            active: Configuration::to(program, state),
            has_begun: false,
            entered_at: vec![0.0; program.states.len()],
            last_inner: vec![None; program.states.len()],
            holding_since: vec![None; program.timers],
            contracts: vec![ContractStatus::default(); program.contracts.len()],
            contracts_of_states: (program.states.iter())
                .map(|state| vec![ContractStatus::default(); state.contracts.len()])
                .collect(),
            count_before: 0.0,
        }
    }

    /// Index of the innermost active state.
    pub(super) fn state(&self) -> usize {
        self.active.innermost()
    }

    /// Takes parameters, further registers, and all that depends only on them from `program`.
    pub(super) fn continue_with<S: Senses>(&mut self, program: &Program, senses: &mut S) {
        let further = program.initial_registers.get(self.registers.len()..).unwrap_or_default();
        self.registers.extend_from_slice(further);
        let parameters = program.initial_registers.iter().take(program.parameters.len());
        self.registers.iter_mut().zip(parameters).for_each(|(own, value)| *own = *value);
        if self.has_begun {
            self.compute(program, &program.start, senses);
        }
    }

    /// Executes one tick, as described at [`Machine::tick`](super::Machine::tick).
    pub(super) fn tick<S: Senses>(
        &mut self,
        program: &Program,
        senses: &mut S,
        action: &mut Action,
        observer: &mut (impl Observer + ?Sized),
    ) -> (Result<(), End>, Option<Fallback>) {
        let now = senses.time();
        self.show_nothing(program);
        let is_first = !std::mem::replace(&mut self.has_begun, true);
        if is_first {
            self.compute(program, &program.start, senses);
            self.compute(program, &program.entry, senses);
        }
        self.compute(program, &program.monitors, senses);
        if is_first {
            self.check_contracts(program, None, Moment::Entry, now, senses, observer);
            self.enter(program, None, (self.state(), false), now, senses, observer);
        }
        let mut enabled = self.enabled(program, None, now, senses, observer);
        for taken in 0..=MICROSTEP_LIMIT {
            if enabled.is_none() {
                enabled = self.enabled_within(program, now, senses, observer);
            }
            let enabled = enabled.take();
            if let Some((transition, target)) = enabled
                && (taken < MICROSTEP_LIMIT || !matches!(target, Target::State { .. }))
            {
                observer.taken(transition);
            }
            match enabled {
                None => {
                    self.watch_contracts(program, now, senses, observer);
                    self.compute(program, &program.body, senses);
                    return match self.run_bodies(program, 0, senses, action) {
                        Ok(()) => (Ok(()), None),
                        Err((state, non_finite)) => {
                            observer.not_finite(state, &self.registers);
                            self.take_fallback(
                                program,
                                (state, Cause::NotFinite(non_finite)),
                                now,
                                senses,
                                action,
                                observer,
                            )
                        }
                    };
                }
                Some((_, Target::Failure(reason))) => return (Err(failure(reason)), None),
                Some((_, Target::Success(reason))) => return (Err(End::Success(Arc::clone(reason))), None),
                Some((transition, Target::State { state, arguments, resume })) if taken < MICROSTEP_LIMIT => {
                    self.take(program, transition.state, (*state, arguments, *resume), now, senses, observer);
                }
                Some((_, Target::State { .. })) => {}
            }
        }
        self.take_fallback(program, (self.state(), Cause::MicrostepLimit), now, senses, action, observer)
    }

    /// The target of the first enabled transition of the active states, from the outermost to the innermost.
    fn enabled_within<'p, S: Senses>(
        &mut self,
        program: &'p Program,
        now: f64,
        senses: &mut S,
        observer: &mut (impl Observer + ?Sized),
    ) -> Option<(TransitionId, &'p Target)> {
        (0..self.active.states().len())
            .find_map(|level| self.enabled(program, Some(self.active.states()[level]), now, senses, observer))
    }

    /// Takes the transition to a target. `from` is the state of the transition, or `None` for a global one.
    fn take<S: Senses>(
        &mut self,
        program: &Program,
        from: Option<usize>,
        (target, arguments, resume): (usize, &Block, bool),
        now: f64,
        senses: &mut S,
        observer: &mut (impl Observer + ?Sized),
    ) {
        let common_ancestor = program.common_ancestor(from, target);
        for left in program.outward(self.state()).take_while(|&left| Some(left) != common_ancestor) {
            self.compute(program, &program.states[left].exit, senses);
        }
        self.compute(program, arguments, senses);
        self.enter(program, common_ancestor, (target, resume), now, senses, observer);
    }

    /// Enters `target` and those of its outer states that are not active yet. Then it enters inner states: the initial
    /// one, or with `resume` the last active one.
    fn enter<S: Senses>(
        &mut self,
        program: &Program,
        common_ancestor: Option<usize>,
        (target, resume): (usize, bool),
        now: f64,
        senses: &mut S,
        observer: &mut (impl Observer + ?Sized),
    ) {
        let (configuration, first) = (
            Configuration::to(program, target),
            common_ancestor.map_or(0, |common_ancestor| program.outward(common_ancestor).count()),
        );
        for &state in &configuration.states()[first..] {
            self.enter_one(program, state, now, senses, observer);
        }
        while let Some((initial, arguments)) = &program.states[self.state()].initial {
            let inner = match self.last_inner[self.state()] {
                Some(last) if resume => last,
                _ => {
                    self.compute(program, arguments, senses);
                    *initial
                }
            };
            self.enter_one(program, inner, now, senses, observer);
        }
    }

    /// Enters one state: records the time, resets its timers, runs its entry code and checks its assumptions.
    fn enter_one<S: Senses>(
        &mut self,
        program: &Program,
        index: usize,
        now: f64,
        senses: &mut S,
        observer: &mut (impl Observer + ?Sized),
    ) {
        let state = &program.states[index];
        self.active = Configuration::to(program, index);
        self.entered_at[index] = now;
        if let Some(parent) = state.parent {
            self.last_inner[parent] = Some(index);
        }
        for transition in &state.transitions {
            if let Guard::When { lasting: Some((_, timer)), .. } = transition.guard {
                self.holding_since[timer] = None;
            }
        }
        self.compute(program, &state.entry, senses);
        self.contracts_of_states[index].iter_mut().for_each(ContractStatus::restart);
        self.check_contracts(program, Some(index), Moment::Entry, now, senses, observer);
    }

    /// Evaluates the contracts of a state, or of the machine for `None`, that belong to a moment.
    fn check_contracts<S: Senses>(
        &mut self,
        program: &Program,
        state: Option<usize>,
        moment: Moment,
        now: f64,
        senses: &mut S,
        observer: &mut (impl Observer + ?Sized),
    ) {
        let contracts = state.map_or(&program.contracts, |state| &program.states[state].contracts);
        for (index, contract) in contracts.iter().enumerate().filter(|(_, contract)| contract.moment == moment) {
            self.compute(program, &contract.code, senses);
            let statuses = state.map_or(&mut self.contracts, |state| &mut self.contracts_of_states[state]);
            if let Some(is_new) = statuses[index].update(contract, &self.registers, now) {
                let id = ContractId { state, index };
                observer.violated(&ViolatedContract { id, contract, is_new, registers: &self.registers });
            }
        }
    }

    /// Evaluates the contracts of the machine and of the active states.
    fn watch_contracts<S: Senses>(
        &mut self,
        program: &Program,
        now: f64,
        senses: &mut S,
        observer: &mut (impl Observer + ?Sized),
    ) {
        self.check_contracts(program, None, Moment::Tick, now, senses, observer);
        for level in 0..self.active.states().len() {
            let state = self.active.states()[level];
            self.check_contracts(program, Some(state), Moment::Tick, now, senses, observer);
        }
    }

    /// After this, no plot and no message belongs to the newest tick.
    pub(super) fn show_nothing(&mut self, program: &Program) {
        self.count_before = program.outputs.count(&self.registers);
    }

    /// The plots that the newest tick has set, by their index, with their values.
    pub(super) fn plotted(&self, program: &Program) -> impl Iterator<Item = (usize, f64)> {
        program.outputs.plotted(&self.registers, self.count_before)
    }

    /// The messages of the newest tick, in the order in which they were logged.
    pub(super) fn logged(&self, program: &Program) -> impl Iterator<Item = LoggedMessage> {
        program.outputs.logged(&self.registers, self.count_before)
    }

    /// The contracts of the machine and of all states, with what was observed.
    pub(super) fn contracts<'m>(&'m self, program: &'m Program) -> impl Iterator<Item = ObservedContract<'m>> {
        fn observed<'m>(
            state: Option<usize>,
            contracts: &'m [Contract],
            statuses: &'m [ContractStatus],
        ) -> impl Iterator<Item = ObservedContract<'m>> {
            contracts.iter().zip(statuses).map(move |(contract, status)| ObservedContract { state, contract, status })
        }
        let of_states = program.states.iter().zip(&self.contracts_of_states).enumerate();
        observed(None, &program.contracts, &self.contracts)
            .chain(of_states.flat_map(|(index, (state, statuses))| observed(Some(index), &state.contracts, statuses)))
    }

    /// Runs the bodies of the active states, except the `from` outermost. The action is the last one given, or
    /// [`Action::Hold`].
    ///
    /// The error contains the state that gave a non-finite action, and the number.
    fn run_bodies<S: Senses>(
        &mut self,
        program: &Program,
        from: usize,
        senses: &mut S,
        action: &mut Action,
    ) -> Result<(), (usize, NonFinite)> {
        *action = Action::Hold;
        let mut giver = self.state();
        for &state in &self.active.states()[from..] {
            if evaluate(&program.code, &program.states[state].body, &mut self.registers, senses, action) {
                giver = state;
            }
        }
        if action.is_finite() {
            return Ok(());
        }
        action.non_finite().map_or(Ok(()), |non_finite| Err((giver, non_finite)))
    }

    /// Runs code that gives no action.
    fn compute<S: Senses>(&mut self, program: &Program, block: &Block, senses: &mut S) {
        compute(&program.code, block, &mut self.registers, senses);
    }

    /// Takes the fallback transition of the state that cannot continue. The entered states only run their bodies. Their
    /// transitions wait for the next tick.
    fn take_fallback<S: Senses>(
        &mut self,
        program: &Program,
        (state_left, cause): (usize, Cause),
        now: f64,
        senses: &mut S,
        action: &mut Action,
        observer: &mut (impl Observer + ?Sized),
    ) -> (Result<(), End>, Option<Fallback>) {
        let outcome = match program.fallback_of(state_left) {
            None => return (Err(End::Failure(cause.failure(&program.states[state_left].name))), None),
            Some((_, Target::Failure(reason))) => Err(failure(reason)),
            Some((_, Target::Success(reason))) => Err(End::Success(Arc::clone(reason))),
            Some((from, Target::State { state, arguments, resume })) => {
                self.take(program, from, (*state, arguments, *resume), now, senses, observer);
                let have_acted = match cause {
                    Cause::NotFinite(_) => program
                        .common_ancestor(from, *state)
                        .map_or(0, |common_ancestor| program.outward(common_ancestor).count()),
                    // No body has run in this tick yet.
                    Cause::MicrostepLimit => {
                        self.compute(program, &program.body, senses);
                        0
                    }
                };
                let acted = self.run_bodies(program, have_acted, senses, action);
                acted.map_err(|(state, non_finite)| {
                    End::Failure(Cause::NotFinite(non_finite).failure(&program.states[state].name))
                })
            }
        };
        (outcome, Some(Fallback { left: state_left, cause }))
    }

    /// The first enabled transition of the state `from`, or of the global transitions for `None`, and its target.
    ///
    /// If that target is already active from outside, only an end of the run among the other transitions counts. All guards are
    /// evaluated, so that the timers of later ones run.
    fn enabled<'p, S: Senses>(
        &mut self,
        program: &'p Program,
        from: Option<usize>,
        now: f64,
        senses: &mut S,
        observer: &mut (impl Observer + ?Sized),
    ) -> Option<(TransitionId, &'p Target)> {
        let (transitions, since) = match from {
            None => (&program.always, 0.0),
            Some(state) => (&program.states[state].transitions, self.entered_at[state]),
        };
        self.compute(program, &guards(transitions), senses);
        let (mut first, mut end): (Option<(TransitionId, &Target)>, _) = (None, None);
        for (index, Transition { guard, target }) in transitions.iter().enumerate() {
            let (transition, standing) = (TransitionId { state: from, index }, self.standing(guard, now - since, now));
            observer.guard(&TriedGuard { transition, standing, registers: &self.registers });
            if standing.is_enabled() {
                first = first.or(Some((transition, target)));
                if let Target::Failure(_) | Target::Success(_) = target {
                    end = end.or(Some((transition, target)));
                }
            }
        }
        match first? {
            (_, Target::State { state, .. }) if program.is_target_active(from, *state, self.state()) => end,
            first => Some(first),
        }
    }

    /// The standing of an evaluated guard. `active` is the time (s) for which its state has been active.
    #[inline]
    fn standing(&mut self, guard: &Guard, active: f64, now: f64) -> Standing {
        match *guard {
            Guard::When { truth, lasting, .. } => {
                let is_met = self.registers[usize::from(truth)] > 0.5;
                let duration = lasting.map(|(duration, timer)| {
                    let since = &mut self.holding_since[timer];
                    let elapsed = if is_met {
                        now - *since.get_or_insert(now)
                    } else {
                        *since = None;
                        0.0
                    };
                    Duration { elapsed, needed: self.registers[usize::from(duration)] }
                });
                Standing { is_met, duration }
            }
            Guard::After { time, .. } => {
                let needed = self.registers[usize::from(time)];
                Standing { is_met: true, duration: Some(Duration { elapsed: active, needed }) }
            }
        }
    }
}

/// The failure of a policy for a reason.
fn failure(reason: &Arc<str>) -> End {
    End::Failure(Failure::Policy(Arc::clone(reason)))
}
