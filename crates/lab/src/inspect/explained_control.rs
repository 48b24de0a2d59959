//! A control loop that explains its guards.

use vibrissa_runtime::control::Control;
use vibrissa_runtime::machine::Tick;
use vibrissa_runtime::signal::{Command, Sample};

use super::breakpoint::Breakpoints;
use super::inspector::{Inspector, from_outside};
use super::records::{GuardRecord, TransitionLine};

/// A control loop whose program explains every guard. With the same samples, its results are those of the optimised program, bit by
/// bit.
#[derive(Debug)]
pub struct ExplainedControl<'b> {
    control: Box<Control>,
    inspector: Inspector<'b>,
    states: Vec<String>,
}

impl<'b> ExplainedControl<'b> {
    /// A control loop of a run in the scenario with this name. `control` has the program of the explained policy.
    #[must_use]
    pub fn new(control: Control, policy: &'b Breakpoints, scenario: &str) -> Self {
        Self { control: Box::new(control), inspector: Inspector::new(policy, scenario), states: Vec::new() }
    }

    /// Executes one tick with the samples since the last tick, oldest first.
    pub fn tick(&mut self, samples: &[Sample]) -> (Command, Tick) {
        self.inspector.begin_tick();
        let ticked = self.control.tick_observed(samples, &mut self.inspector);
        self.states = names(&self.control);
        let state = (!self.states.is_empty()).then(|| self.control.machine().state());
        self.inspector.end_tick(self.control.perception().time(), state);
        ticked
    }

    /// The control loop.
    #[must_use]
    pub fn control(&self) -> &Control {
        &self.control
    }

    /// The names of the active states, from the outermost to the innermost. Empty after the end of the machine.
    #[must_use]
    pub fn states(&self) -> &[String] {
        &self.states
    }

    /// All transitions that were taken.
    #[must_use]
    pub fn transitions(&self) -> &[TransitionLine] {
        self.inspector.transitions()
    }

    /// The guards that were tried after the last transition of the tick, in the order in which they were tried.
    #[must_use]
    pub fn guards(&self) -> Vec<GuardRecord> {
        self.inspector.guards()
    }
}

fn names(control: &Control) -> Vec<String> {
    let machine = control.machine();
    if machine.failure().is_some() || machine.success().is_some() {
        return Vec::new();
    }
    let program = machine.program();
    let states = from_outside(program, machine.state()).into_iter();
    states.map(|state| program.states[state].name.to_string()).collect()
}
