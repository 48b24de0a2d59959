//! The observer of a run that explains its transitions.

use std::ops::ControlFlow;

use vibrissa_runtime::machine::{
    ContractId, Observer, Program, Standing, Target, TransitionId, TriedGuard, ViolatedContract,
};

use crate::run::{Trace, Watcher};
use vibrissa_language::explain::Variable;

use super::breakpoint::{Breakpoint, BreakpointTick, BreakpointWatch, Breakpoints, Place};
use super::records::{GuardRecord, LeafRecord, StopRecord, TransitionLine, VariableRecord, ViolationLine};
use super::tried_guards::TriedGuards;

/// Watches one run of an explained policy. It collects the transitions that are taken, and stops the run at a breakpoint.
///
/// The run must have the program of the explained policy.
#[derive(Debug)]
pub struct Inspector<'b> {
    policy: &'b Breakpoints,
    scenario: String,
    guards: TriedGuards,
    /// The transitions of the current tick.
    taken: Vec<TransitionLine>,
    /// The innermost active state.
    innermost: Option<usize>,
    /// The first tick after the entry of the innermost state.
    entered: usize,
    ticks: usize,
    transitions: Vec<TransitionLine>,
    /// The violations of contracts in the current tick, and in earlier ones.
    violated: Vec<ViolationLine>,
    violations: Vec<ViolationLine>,
    watch: BreakpointWatch,
    stop: Option<StopRecord>,
    origin: Option<String>,
}

impl<'b> Inspector<'b> {
    /// An inspector of a run in the scenario with this name.
    #[must_use]
    pub fn new(policy: &'b Breakpoints, scenario: &str) -> Self {
        Self {
            policy,
            scenario: scenario.to_owned(),
            guards: TriedGuards::default(),
            taken: Vec::new(),
            innermost: Some(policy.explained.program.initial),
            entered: 0,
            ticks: 0,
            transitions: Vec::new(),
            violated: Vec::new(),
            violations: Vec::new(),
            watch: BreakpointWatch::default(),
            stop: None,
            origin: None,
        }
    }

    /// All transitions that were taken.
    #[must_use]
    pub fn transitions(&self) -> &[TransitionLine] {
        &self.transitions
    }

    /// The violations of contracts. One that lasts for several ticks is listed once.
    #[must_use]
    pub fn violations(&self) -> &[ViolationLine] {
        &self.violations
    }

    /// The stop at a breakpoint, if there was one.
    #[must_use]
    pub fn stop(&self) -> Option<&StopRecord> {
        self.stop.as_ref()
    }

    /// The expression at which the first number that is not finite arose, if a command contained one.
    #[must_use]
    pub fn origin_of_non_finite(&self) -> Option<&str> {
        self.origin.as_deref()
    }

    fn state_name(&self, state: usize) -> String {
        self.policy.explained.program.states.get(state).map_or_else(String::new, |state| state.name.to_string())
    }

    fn record(&self, id: TransitionId, standing: Standing) -> Option<GuardRecord> {
        let transition = self.policy.explained.transition(id)?;
        Some(GuardRecord::new(
            id.state.map(|state| self.state_name(state)),
            transition,
            standing,
            &self.guards.registers,
        ))
    }

    /// The records of the guards that were tried since the last transition, without those of breakpoints.
    fn records(&self, except: Option<TransitionId>) -> Vec<GuardRecord> {
        let tried = self.guards.tried.iter().filter(|(id, _)| Some(*id) != except && !self.is_breakpoint(*id));
        tried.filter_map(|&(id, standing)| self.record(id, standing)).collect()
    }

    fn is_breakpoint(&self, id: TransitionId) -> bool {
        let is_its = |breakpoint: &Breakpoint| breakpoint.place == Place::Condition(id.index);
        id.state.is_none() && self.policy.breakpoints.iter().any(is_its)
    }

    /// The first breakpoint that the tick at `time` (s) hit. `state` is the innermost active state.
    fn hit(&mut self, state: usize, time: f64) -> Option<&'b Breakpoint> {
        let (has_entered, registers) = (self.entered == self.ticks, self.guards.registers.as_slice());
        let tick = BreakpointTick { time, state, has_entered, taken: &self.guards.taken, registers };
        self.watch.hit(self.policy, &tick)
    }

    fn stopped(&self, breakpoint: &Breakpoint, time_s: f64, innermost: usize) -> StopRecord {
        let explained = &self.policy.explained;
        let states = from_outside(&explained.program, innermost);
        let variables = |state: Option<usize>, variables: &[Variable]| {
            let name = state.map(|state| self.state_name(state));
            let value = |variable: &Variable| {
                let value = variable.value(&explained.program, &self.guards.registers)?.to_string();
                Some(VariableRecord { state: name.clone(), name: variable.name.clone(), value })
            };
            variables.iter().filter_map(value).collect::<Vec<_>>()
        };
        let of_states = states.iter().flat_map(|&state| {
            variables(Some(state), explained.memory_of_states.get(state).map_or(&[], Vec::as_slice))
        });
        StopRecord {
            scenario: self.scenario.clone(),
            breakpoint: breakpoint.text.clone(),
            time_s,
            tick: self.ticks,
            states: states.iter().map(|&state| self.state_name(state)).collect(),
            taken: self.taken.iter().map(|line| line.taken.clone()).collect(),
            guards: self.records(None),
            variables: variables(None, &explained.memory).into_iter().chain(of_states).collect(),
        }
    }
}

impl Observer for Inspector<'_> {
    fn guard(&mut self, tried: &TriedGuard<'_>) {
        self.guards.guard(tried);
    }

    fn taken(&mut self, transition: TransitionId) {
        let standing = self.guards.tried.iter().find(|(id, _)| *id == transition).map(|&(_, standing)| standing);
        let taken = standing.and_then(|standing| self.record(transition, standing));
        if let Some(taken) = taken {
            let left = self.innermost.map_or_else(String::new, |state| self.state_name(state));
            let ticks_in_state = self.ticks - self.entered;
            let others = self.records(Some(transition));
            let (scenario, tick) = (self.scenario.clone(), self.ticks);
            self.taken.push(TransitionLine { scenario, time_s: 0.0, tick, left, ticks_in_state, taken, others });
        }
        self.entered = self.ticks;
        self.guards.taken(transition);
        // The innermost state is known at the next guard of a state, or at the end of the tick.
        self.innermost = self.target(transition);
    }

    fn violated(&mut self, violated: &ViolatedContract<'_>) {
        let ViolatedContract { id: ContractId { state, .. }, is_new, registers, .. } = *violated;
        let Some(contract) = self.policy.explained.contract(violated.id).filter(|_| is_new) else { return };
        self.violated.push(ViolationLine {
            scenario: self.scenario.clone(),
            time_s: 0.0,
            tick: self.ticks,
            state: state.map(|state| self.state_name(state)),
            contract: contract.text.clone(),
            file: contract.file.clone(),
            line: contract.position.line,
            parts: contract.violation.judge(registers).iter().map(LeafRecord::new).collect(),
        });
    }

    fn not_finite(&mut self, state: usize, registers: &[f64]) {
        if self.origin.is_none() {
            self.origin = self.policy.explained.origin_of_non_finite(state, registers);
        }
    }
}

impl Inspector<'_> {
    /// The innermost state that a transition enters, if history does not choose another one.
    fn target(&self, id: TransitionId) -> Option<usize> {
        let program = &self.policy.explained.program;
        let transitions =
            id.state.map_or(Some(&program.always), |state| Some(&program.states.get(state)?.transitions))?;
        let Target::State { state, .. } = &transitions.get(id.index)?.target else { return None };
        let inner = |&state: &usize| program.states.get(state)?.initial.as_ref().map(|(inner, _)| *inner);
        std::iter::successors(Some(*state), inner).last()
    }

    /// Ends the records of a tick at a time (s). `state` is the innermost active state, or `None` after the end of the machine.
    pub(super) fn end_tick(&mut self, time_s: f64, state: Option<usize>) {
        self.taken.iter_mut().for_each(|line| line.time_s = time_s);
        self.violated.iter_mut().for_each(|line| line.time_s = time_s);
        self.violations.append(&mut self.violated);
        self.innermost = state.or(self.innermost);
        if let Some(state) = state
            && let Some(breakpoint) = self.hit(state, time_s)
        {
            self.stop = Some(self.stopped(breakpoint, time_s, state));
        }
        self.transitions.append(&mut self.taken);
        self.ticks += 1;
    }

    /// The guards that were tried after the last transition of the tick, in the order in which they were tried.
    pub(super) fn guards(&self) -> Vec<GuardRecord> {
        self.records(None)
    }

    /// Begins the next tick.
    pub(super) fn begin_tick(&mut self) {
        self.guards.begin_tick();
    }
}

impl Watcher for Inspector<'_> {
    fn after_tick(&mut self, trace: &Trace) -> ControlFlow<()> {
        if let Some(tick) = trace.ticks.last() {
            self.end_tick(tick.time, tick.state);
        }
        self.begin_tick();
        if self.stop.is_some() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}

/// A state with its outer states, from the outermost to the innermost.
pub(super) fn from_outside(program: &Program, state: usize) -> Vec<usize> {
    let mut states: Vec<usize> = program.outward(state).collect();
    states.reverse();
    states
}
