//! The first tick at which two policies differ on the same samples.

use serde::Serialize;

use vibrissa_runtime::control::Control;
use vibrissa_runtime::machine::Tick;
use vibrissa_runtime::signal::{Command, Sample};

use crate::results::Document;
use crate::run::Monitor;
use crate::trial::{ExecuteError, Trial};

use super::breakpoint::Breakpoints;
use super::explained_control::ExplainedControl;
use super::records::{GuardRecord, TransitionLine};

/// The comparison of two policies on the samples of a run of the first one.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
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
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
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
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
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
    let scenario = trial.scene.name.as_str();
    let mut world = trial.world()?;
    let [own, other] = [trial, second].map(Trial::control);
    let mut pair = PolicyPair::new([(own?, policies[0]), (other?, policies[1])], scenario);
    let period = trial.scene.rig.sensing.control_rate.recip();
    let mut monitor = Monitor::new(pair.first(), trial.scene.goal(), period);
    let mut command = Command::STOP;
    while let Ok(samples) = world.advance(&command)
        && let Some((next, tick)) = pair.tick(samples)
    {
        command = next;
        if monitor.observe(pair.first(), command, &tick, world.as_ref()).is_some() {
            break;
        }
    }
    Ok(pair.difference)
}

/// Two policies with the same samples.
#[derive(Debug)]
pub struct PolicyPair<'b> {
    first: ExplainedControl<'b>,
    second: ExplainedControl<'b>,
    /// The comparison of the ticks until now.
    pub difference: PolicyDifference,
}

impl<'b> PolicyPair<'b> {
    /// The control loops of both policies, at the beginning of a run in the scenario with this name.
    #[must_use]
    pub fn new([first, second]: [(Control, &'b Breakpoints); 2], scenario: &str) -> Self {
        let side = |(control, policy): (Control, &'b Breakpoints)| ExplainedControl::new(control, policy, scenario);
        let difference =
            PolicyDifference { scenario: scenario.to_owned(), equal_ticks: 0, states_differ_from: None, first: None };
        Self { first: side(first), second: side(second), difference }
    }

    /// The control loop of the first policy.
    #[must_use]
    pub fn first(&self) -> &Control {
        self.first.control()
    }

    /// Executes a tick of both policies. The result is that of the first one, or `None` if their commands differ.
    pub fn tick(&mut self, samples: &[Sample]) -> Option<(Command, Tick)> {
        let (command, tick) = self.first.tick(samples);
        let (others, _) = self.second.tick(samples);
        let PolicyDifference { equal_ticks, states_differ_from, first, .. } = &mut self.difference;
        if self.first.states() != self.second.states() {
            states_differ_from.get_or_insert(*equal_ticks);
        }
        if bits(command) != bits(others) {
            let time_s = self.first.control().perception().time();
            let (own, other) = (policy_tick(&self.first, command), policy_tick(&self.second, others));
            *first = Some(DifferentTick { tick: *equal_ticks, time_s, first: own, second: other });
            return None;
        }
        *equal_ticks += 1;
        Some((command, tick))
    }
}

fn policy_tick(policy: &ExplainedControl<'_>, command: Command) -> PolicyTick {
    PolicyTick {
        policy: policy.control().machine().program().name.clone(),
        states: policy.states().to_vec(),
        velocity_m_s: command.velocity_world.into(),
        yaw_rate_rad_s: command.yaw_rate,
        last: policy.transitions().last().cloned(),
        guards: policy.guards(),
    }
}

/// The bits of a command.
fn bits(command: Command) -> [u64; 3] {
    [command.velocity_world.x, command.velocity_world.y, command.yaw_rate].map(f64::to_bits)
}
