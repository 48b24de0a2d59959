//! The first tick at which two policies differ on the same samples.

use serde::Serialize;

use vibrissa_runtime::control::Control;
use vibrissa_runtime::machine::Tick;
use vibrissa_runtime::signal::{Command, Sample};

use crate::results::Document;
use crate::run::Monitor;
use crate::trial::{ExecuteError, Trial};

use super::breakpoint::Breakpoints;
use super::inspector::{Inspector, from_outside};
use super::records::{GuardRecord, TransitionLine};

/// The comparison of two policies on the samples of a run of the first one.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct PolicyDifference {
    /// Name of the scenario.
    pub scenario: String,
    /// Number of ticks in which both policies give the same command.
    pub equal_ticks: usize,
    /// The first tick in which the names of their active states differ. `None` if there is none among the equal ticks.
    pub states_differ_from: Option<usize>,
    /// The first tick in which their commands differ. `None` if there is none until the run ends.
    pub first: Option<DifferentTick>,
}

impl Document for PolicyDifference {
    const FORMAT: &'static str = "policy-difference";
}

/// A tick in which two policies differ.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct DifferentTick {
    /// Index of the tick.
    pub tick: usize,
    /// Time since the start of the run.
    pub time_s: f64,
    /// The first policy, whose commands moved the platform.
    pub first: PolicyTick,
    /// The second policy.
    pub second: PolicyTick,
}

/// One policy in a tick.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct PolicyTick {
    /// Name of the policy.
    pub policy: String,
    /// The active states after the tick, from the outermost to the innermost. Empty after the end of the machine.
    pub states: Vec<String>,
    /// Commanded velocity of the centre of mass in the world frame.
    pub velocity_m_s: [f64; 2],
    /// Commanded yaw rate, counter-clockwise positive.
    pub yaw_rate_rad_s: f64,
    /// The last transition that was taken. `None` if there was none.
    pub last: Option<TransitionLine>,
    /// The guards that were tried after it in this tick, in the order in which they were tried.
    pub guards: Vec<GuardRecord>,
}

/// Runs `trial` and gives its samples to a second policy as well. Both differ in a tick if a bit of their commands differs.
///
/// # Errors
/// [`ExecuteError`] if the run cannot begin, or if the rig does not have what a policy needs.
pub fn first_difference(
    trial: &Trial,
    policies: [&Breakpoints; 2],
    second: &Trial,
) -> Result<PolicyDifference, ExecuteError> {
    let scenario = trial.scene.name.clone();
    let mut world = trial.world()?;
    let (mut own, mut other) = (Side::new(trial, policies[0], &scenario)?, Side::new(second, policies[1], &scenario)?);
    let period = trial.scene.rig.sensing.control_rate.recip();
    let mut monitor = Monitor::new(&own.control, &trial.scene.stop, period);
    let (mut command, mut equal_ticks, mut states_differ_from) = (Command::STOP, 0, None);
    let first = loop {
        let Ok(samples) = world.advance(&command) else { break None };
        let (next, tick) = own.tick(samples);
        let (others, _) = other.tick(samples);
        if own.states != other.states {
            states_differ_from.get_or_insert(equal_ticks);
        }
        if bits(next) != bits(others) {
            let (first, second) = (own.record(next), other.record(others));
            break Some(DifferentTick { tick: equal_ticks, time_s: own.control.perception().time(), first, second });
        }
        equal_ticks += 1;
        command = next;
        if monitor.observe(&own.control, command, &tick, world.as_ref()).is_some() {
            break None;
        }
    };
    Ok(PolicyDifference { scenario, equal_ticks, states_differ_from, first })
}

/// One of the policies.
struct Side<'b> {
    control: Box<Control>,
    inspector: Inspector<'b>,
    states: Vec<String>,
}

impl<'b> Side<'b> {
    fn new(trial: &Trial, policy: &'b Breakpoints, scenario: &str) -> Result<Self, ExecuteError> {
        let inspector = Inspector::new(policy, scenario);
        Ok(Self { control: Box::new(trial.control()?), inspector, states: Vec::new() })
    }

    fn tick(&mut self, samples: &[Sample]) -> (Command, Tick) {
        self.inspector.begin_tick();
        let ticked = self.control.tick_observed(samples, &mut self.inspector);
        self.states = names(&self.control);
        let machine = self.control.machine();
        let state = (!self.states.is_empty()).then(|| machine.state());
        self.inspector.end_tick(self.control.perception().time(), state);
        ticked
    }

    fn record(&self, command: Command) -> PolicyTick {
        PolicyTick {
            policy: self.control.machine().program().name.clone(),
            states: self.states.clone(),
            velocity_m_s: command.velocity_world.into(),
            yaw_rate_rad_s: command.yaw_rate,
            last: self.inspector.transitions().last().cloned(),
            guards: self.inspector.guards(),
        }
    }
}

/// The names of the active states, from the outermost to the innermost.
fn names(control: &Control) -> Vec<String> {
    let machine = control.machine();
    if machine.failure().is_some() || machine.success().is_some() {
        return Vec::new();
    }
    let program = machine.program();
    let states = from_outside(program, machine.state()).into_iter();
    states.map(|state| program.states[state].name.to_string()).collect()
}

fn bits(command: Command) -> [u64; 3] {
    [command.velocity_world.x, command.velocity_world.y, command.yaw_rate].map(f64::to_bits)
}
