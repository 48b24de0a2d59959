//! The payloads of the topics, as JSON. Quantities are in SI units, and the key of a quantity ends in its unit. A value that
//! does not exist is `null`. Times are counted from the start of the program.

use serde::{Deserialize, Serialize};

use crate::fault::{FaultChange, FaultKind};

/// A message of the telemetry: its content, its number and its time.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Numbered<T> {
    /// Number of the message, from 1, over all topics with such messages. A message that arrives twice has the same number
    /// twice. Numbers that never arrive are those of dropped messages.
    pub sequence: u64,
    /// Time of the content (s).
    pub time_s: f64,
    /// The same time by the system's clock (s since 1970).
    pub unix_s: f64,
    /// The content.
    #[serde(flatten)]
    pub content: T,
}

/// The state of the machine. It is sent after every change, and once per second.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct State {
    /// Name of the policy.
    pub policy: String,
    /// Name of the active state, or `null` before the first tick.
    pub state: Option<String>,
    /// True if the machine has failed.
    pub has_failed: bool,
    /// True while a fault stops the robot, so that the machine waits.
    pub is_paused: bool,
}

/// The rounds of all buses since the last message: one control period.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Samples {
    /// The buses with new rounds.
    pub buses: Vec<BusSamples>,
}

/// The rounds of a bus.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct BusSamples {
    /// Device file of the bus.
    pub bus: String,
    /// Start of each round (s).
    pub time_s: Vec<f64>,
    /// The whiskers of the bus.
    pub whiskers: Vec<WhiskerSamples>,
}

/// The samples of a whisker, one for each round.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct WhiskerSamples {
    /// Name of the whisker.
    pub whisker: String,
    /// Field along the measured axis of the sensor (T). `null` if the sensor had no new, valid value.
    pub field_t: Vec<Option<f64>>,
    /// Base angle (rad). `null` too until the neutral values have been measured.
    pub base_angle_rad: Vec<Option<f64>>,
}

/// The perception of a control tick. There is none while the machine waits.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Perception {
    /// Pose of the platform.
    pub pose: Option<Pose>,
    /// The whiskers that the policy uses.
    pub whiskers: Vec<PerceivedWhisker>,
    /// Age of the newest sample at the start of the tick (s).
    pub sample_age_s: f64,
}

/// A pose of the platform in the world frame.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Pose {
    /// Position of the centre of mass: x and y (m).
    pub position_m: [f64; 2],
    /// Heading (rad).
    pub heading_rad: f64,
}

/// A whisker as perceived.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PerceivedWhisker {
    /// Name of the whisker.
    pub whisker: String,
    /// Filtered base angle (rad).
    pub base_angle_rad: Option<f64>,
    /// Estimated tip of a whisker in contact, in the world frame (m).
    pub tip_m: Option<[f64; 2]>,
}

/// The commands of a control period.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CommandLog {
    /// Command of the machine, or `null` while it waits.
    pub machine: Option<Motion>,
    /// The packets that the actuator was sent since the last message.
    pub packets: Vec<SentPacket>,
}

/// A motion of the platform.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Motion {
    /// Velocity of the centre of mass in the world frame: x and y (m/s).
    pub velocity_m_per_s: [f64; 2],
    /// Yaw rate (rad/s).
    pub yaw_rate_rad_per_s: f64,
}

/// A packet to the actuator.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct SentPacket {
    /// Number of the packet.
    pub packet: u64,
    /// Time of the packet (s).
    pub time_s: f64,
    /// The motion, within all limits.
    #[serde(flatten)]
    pub motion: Motion,
    /// True if the supervisor stops the robot.
    pub is_stop: bool,
}

/// The health of the program. It is sent once per second.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Health {
    /// Version of all payloads. It is raised when a key is removed or changes its meaning.
    pub version: u32,
    /// True once the neutral values have been measured, so that the machine is executed.
    pub is_running: bool,
    /// The faults that are present.
    pub faults: Vec<Fault>,
    /// Periods that a thread has missed since the start.
    pub missed_periods: MissedPeriods,
    /// Records of the loop that have been lost since the start, because the telemetry thread was late.
    pub lost_records: u64,
    /// Messages that wait for the broker.
    pub buffered_messages: usize,
    /// Messages that have been dropped since the start, because the buffer was full.
    pub dropped_messages: u64,
}

/// A fault.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Fault {
    /// Its kind.
    pub fault: FaultKind,
    /// Name of the whisker, or device file of the bus. `null` for other kinds.
    pub part: Option<String>,
}

/// Missed periods of each phase of the loop.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct MissedPeriods {
    /// Rounds, over all buses.
    pub acquisition: u64,
    /// Control ticks.
    pub control: u64,
    /// Steps of the supervisor.
    pub supervision: u64,
}

/// A change of a fault.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct FaultNote {
    /// The fault.
    #[serde(flatten)]
    pub fault: Fault,
    /// The change.
    pub change: FaultChange,
}

/// Durations since the start. It is sent every five seconds.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Latency {
    /// From the scheduled start to the end of a round, for each bus.
    pub rounds: Vec<Durations>,
    /// Of a control tick.
    pub tick: Durations,
    /// From the scheduled to the real start of a control tick.
    pub tick_lateness: Durations,
    /// Age of the newest sample at the start of a control tick.
    pub sample_age: Durations,
}

/// A histogram of durations.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Durations {
    /// Number of durations.
    pub count: u64,
    /// The largest duration (s).
    pub largest_s: f64,
    /// The upper end (s) of each bucket that is not empty, in ascending order.
    pub upper_end_s: Vec<f64>,
    /// Number of durations in each of these buckets.
    pub counts: Vec<u64>,
}

/// Messages have been dropped, because the buffer was full. It is sent before the first message after them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Dropped {
    /// Messages that have been dropped since the start.
    pub dropped_messages: u64,
}

/// The payload of [`Topic::Status`](super::Topic::Status) while the program runs.
pub const ONLINE: &str = "online";
/// The payload of [`Topic::Status`](super::Topic::Status) after it. It is also the last will.
pub const OFFLINE: &str = "offline";
/// The version of all payloads.
pub const VERSION: u32 = 1;
