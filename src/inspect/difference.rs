//! The first tick at which two policies differ on the same samples.

use serde::Serialize;

use vibrissa_runtime::control::Control;
use vibrissa_runtime::signal::Command;

use crate::results::Document;
use crate::run::Monitor;
use crate::trial::{ExecuteError, Trial};

use super::breakpoint::Breakpoints;
use super::inspector::Inspector;
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
    let (mut world, mut controls) = (trial.world()?, [trial.control()?, second.control()?]);
    let mut inspectors = policies.map(|policy| Inspector::new(policy, &scenario));
    let period = trial.scene.rig.sensing.control_rate.recip();
    let mut monitor = Monitor::new(&controls[0], &trial.scene.stop, period);
    let (mut command, mut equal_ticks, mut states_differ_from) = (Command::STOP, 0, None);
    let first = loop {
        let Ok(samples) = world.advance(&command) else { break None };
        let mut ticked = controls.iter_mut().zip(&mut inspectors).map(|(control, inspector)| {
            inspector.begin_tick();
            let (command, tick) = control.tick_observed(samples, inspector);
            (names(control), command, tick)
        });
        let (Some(own), Some(other)) = (ticked.next(), ticked.next()) else { break None };
        drop(ticked);
        let time = controls[0].perception().time();
        for (control, inspector) in controls.iter().zip(&mut inspectors) {
            let is_running = control.machine().failure().is_none() && control.machine().success().is_none();
            inspector.end_tick(time, is_running.then(|| control.machine().state()));
        }
        if own.0 != other.0 {
            states_differ_from.get_or_insert(equal_ticks);
        }
        if bits(own.1) != bits(other.1) {
            let [one, two] = [(own, 0), (other, 1)].map(|((states, command, _), index)| PolicyTick {
                policy: controls[index].machine().program().name.clone(),
                states,
                velocity_m_s: command.velocity_world.into(),
                yaw_rate_rad_s: command.yaw_rate,
                last: inspectors[index].transitions().last().cloned(),
                guards: inspectors[index].guards(),
            });
            break Some(DifferentTick { tick: equal_ticks, time_s: time, first: one, second: two });
        }
        equal_ticks += 1;
        command = own.1;
        if monitor.observe(&controls[0], command, &own.2, world.as_ref()).is_some() {
            break None;
        }
    };
    Ok(PolicyDifference { scenario, equal_ticks, states_differ_from, first })
}

/// The names of the active states, from the outermost to the innermost.
fn names(control: &Control) -> Vec<String> {
    let machine = control.machine();
    if machine.failure().is_some() || machine.success().is_some() {
        return Vec::new();
    }
    let program = machine.program();
    let mut names: Vec<String> =
        program.outward(machine.state()).map(|state| program.states[state].name.to_string()).collect();
    names.reverse();
    names
}

fn bits(command: Command) -> [u64; 3] {
    [command.velocity_world.x, command.velocity_world.y, command.yaw_rate].map(f64::to_bits)
}
