//! A second control loop beside that of the run. It explains the guards, and its copies are where counterfactuals begin.

use std::sync::Arc;

use vibrissa_runtime::control::Control;
use vibrissa_runtime::machine::{Standing, TransitionId};
use vibrissa_runtime::signal::{Command, Sample};

use super::guards::GuardNumbers;
use super::message::GuardFrame;
use crate::inspect::{BreakpointTick, BreakpointWatch, Breakpoints, TriedGuards};

/// A control loop with the same samples as that of the run. If the policy has a text, its program explains the guards.
#[derive(Debug, Clone)]
pub struct Shadow {
    control: Control,
    policy: Option<Arc<Breakpoints>>,
    watch: BreakpointWatch,
    observed: TriedGuards,
    ticks: usize,
}

impl Shadow {
    /// A loop at the start of a run. `control` has the program of the explained policy, if there is one.
    #[must_use]
    pub fn new(control: Control, policy: Option<Arc<Breakpoints>>) -> Self {
        Self { control, policy, watch: BreakpointWatch::default(), observed: TriedGuards::default(), ticks: 0 }
    }

    /// Executes a tick. The result is the text of the breakpoint that it hits.
    pub fn tick(&mut self, samples: &[Sample]) -> (Command, Option<String>) {
        self.observed.begin_tick();
        let (command, _) = self.control.tick_observed(samples, &mut self.observed);
        let tick = BreakpointTick {
            time: self.control.perception().time(),
            state: self.control.machine().state(),
            has_entered: self.ticks == 0 || !self.observed.taken.is_empty(),
            taken: &self.observed.taken,
            registers: &self.observed.registers,
        };
        self.ticks += 1;
        let policy = self.policy.as_ref().filter(|_| !self.has_ended());
        (command, policy.and_then(|policy| self.watch.hit(policy, &tick)).map(|breakpoint| breakpoint.text.clone()))
    }

    /// True after the machine has failed or succeeded.
    #[must_use]
    pub fn has_ended(&self) -> bool {
        let machine = self.control.machine();
        machine.failure().is_some() || machine.success().is_some()
    }

    /// The explained policy, if it has a text.
    #[must_use]
    pub fn policy(&self) -> Option<&Breakpoints> {
        self.policy.as_deref()
    }

    /// The control loop.
    #[must_use]
    pub fn control(&self) -> &Control {
        &self.control
    }

    /// The guards of the newest tick.
    #[must_use]
    pub fn guards(&self, numbers: &GuardNumbers) -> Vec<GuardFrame> {
        let Some(policy) = &self.policy else { return Vec::new() };
        let frame = |&(id, standing): &(TransitionId, Standing)| {
            let (guard, transition) = (numbers.number(id)?, policy.explained.transition(id)?);
            let condition = transition.condition.as_ref();
            let parts = condition.map(|condition| condition.judge(&self.observed.registers)).unwrap_or_default();
            let missing = condition.map(|condition| condition.missing(&self.observed.registers)).unwrap_or_default();
            let place = |leaf| parts.iter().position(|part| std::ptr::eq(part.leaf, leaf));
            Some(GuardFrame {
                guard,
                met: standing.is_met,
                margins: parts.iter().map(|part| Some(part.margin?.0).filter(|margin| margin.is_finite())).collect(),
                missing: missing.iter().filter_map(|part| place(part.leaf)).collect(),
                elapsed: standing.duration.map(|duration| duration.elapsed),
                needed: standing.duration.map(|duration| duration.needed).filter(|needed| needed.is_finite()),
            })
        };
        self.observed.tried.iter().filter_map(frame).collect()
    }

    /// The numbers of the guards of the transitions that the newest tick has taken.
    #[must_use]
    pub fn taken(&self, numbers: &GuardNumbers) -> Vec<usize> {
        self.observed.taken.iter().filter_map(|&id| numbers.number(id)).collect()
    }
}
