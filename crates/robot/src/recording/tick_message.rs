//! The messages of ticks, events and packets.

use serde::{Deserialize, Serialize};
use vibrissa_runtime::geometry::Pose;
use vibrissa_runtime::machine::{Program, Status};
use vibrissa_runtime::signal::Command;

use super::number::Number;
use crate::drive::TickReport;
use crate::fault::{Fault, FaultChange, FaultEvent, FaultKind};
use crate::link::CommandPacket;

/// The results of a step that has executed the machine, or would have without a stop.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(super) struct TickMessage {
    /// Scheduled time of the step since the start of the program (ns).
    due_ns: u64,
    /// Start of the step (ns).
    pub(super) started_ns: u64,
    /// End of the step (ns).
    pub(super) ended_ns: u64,
    /// Age of the newest sample at the start of the step (ns).
    sample_age_ns: u64,
    /// Index of the active state.
    state: u16,
    /// Name of the active state.
    state_name: String,
    /// True if the machine has failed.
    has_failed: bool,
    /// Pose of the platform in the world frame.
    pose: TickPose,
    /// Filtered base angles (rad), in the order of the policy's whiskers.
    base_angles: Vec<Number>,
    /// The tips that were recorded in this step.
    tips: Vec<TipMessage>,
    /// The command.
    command: CommandMessage,
    /// True while the supervisor stops the robot. The machine has not been executed.
    is_paused: bool,
}

/// A recorded tip.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
struct TipMessage {
    /// Index of the whisker in the policy.
    whisker: usize,
    /// Position in the world frame, x (m).
    x: Number,
    /// Position in the world frame, y (m).
    y: Number,
}

/// A pose of the platform.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
struct TickPose {
    /// Position of the centre of mass, x (m).
    x: Number,
    /// Position of the centre of mass, y (m).
    y: Number,
    /// Heading (rad), not wrapped.
    heading: Number,
}

/// A command.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
struct CommandMessage {
    /// Velocity of the centre of mass in the world frame, x (m/s).
    x: Number,
    /// Velocity of the centre of mass in the world frame, y (m/s).
    y: Number,
    /// Yaw rate (rad/s).
    yaw_rate: Number,
}

/// A change of a fault.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(super) struct EventMessage {
    /// Time since the start of the program (ns).
    time_ns: u64,
    /// Kind of the fault, such as `sensor_stale`.
    #[cfg_attr(test, schemars(with = "String"))]
    kind: FaultKind,
    /// Index of the bus or whisker that has it. 0 for other kinds.
    part: u8,
    /// The change: `detected`, `reacted` or `recovered`.
    #[cfg_attr(test, schemars(with = "String"))]
    change: FaultChange,
}

/// A packet from the supervisor to the actuator.
#[derive(Debug, Clone, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(super) struct PacketMessage {
    /// Sequence number, from 1.
    sequence: u64,
    /// Time since the start of the program (ns).
    time_ns: u64,
    /// The command.
    command: CommandMessage,
    /// True if the supervisor stops the robot.
    is_stop: bool,
}

impl TickMessage {
    /// The message of a tick of a machine with this program.
    pub(super) fn new(report: &TickReport, program: &Program) -> Self {
        let Pose { position, heading } = report.pose;
        let whiskers = program.whiskers.len();
        let state = program.states.get(usize::from(report.state));
        Self {
            due_ns: report.due_ns,
            started_ns: report.started_ns,
            ended_ns: report.ended_ns,
            sample_age_ns: report.sample_age_ns,
            state: report.state,
            state_name: state.map(|state| state.name.to_string()).unwrap_or_default(),
            has_failed: report.status == Status::Failed,
            pose: TickPose { x: position.x.into(), y: position.y.into(), heading: heading.into() },
            base_angles: report.base_angles.iter().take(whiskers).copied().map(Number::from).collect(),
            tips: report.tips.iter().enumerate().filter_map(|(whisker, tip)| TipMessage::new(whisker, *tip)).collect(),
            command: report.command.into(),
            is_paused: report.is_paused,
        }
    }
}

impl TipMessage {
    fn new(whisker: usize, tip: Option<[f64; 2]>) -> Option<Self> {
        tip.map(|[x, y]| Self { whisker, x: x.into(), y: y.into() })
    }
}

impl From<&FaultEvent> for EventMessage {
    fn from(event: &FaultEvent) -> Self {
        let &FaultEvent { time_ns, fault: Fault { kind, part }, change } = event;
        Self { time_ns, kind, part, change }
    }
}

impl From<EventMessage> for FaultEvent {
    fn from(message: EventMessage) -> Self {
        let EventMessage { time_ns, kind, part, change } = message;
        Self { time_ns, fault: Fault { kind, part }, change }
    }
}

impl From<Command> for CommandMessage {
    fn from(command: Command) -> Self {
        let Command { velocity_world, yaw_rate } = command;
        Self { x: velocity_world.x.into(), y: velocity_world.y.into(), yaw_rate: yaw_rate.into() }
    }
}

impl From<&CommandPacket> for PacketMessage {
    fn from(packet: &CommandPacket) -> Self {
        let &CommandPacket { sequence, time_ns, command, is_stop } = packet;
        Self { sequence, time_ns, command: command.into(), is_stop }
    }
}
