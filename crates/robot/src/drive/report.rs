//! The report of a control tick, for telemetry and recordings.

use vibrissa_runtime::geometry::Pose;
use vibrissa_runtime::machine::Status;
use vibrissa_runtime::signal::{Command, MAX_WHISKERS};

/// What a control tick has perceived and done. It has a fixed size, so that reporting allocates no memory.
#[derive(Debug, Clone, Copy)]
pub struct TickReport {
    /// Scheduled time of the tick since the start of the program (ns).
    pub due_ns: u64,
    /// Start of the tick (ns).
    pub started_ns: u64,
    /// End of the tick (ns).
    pub ended_ns: u64,
    /// Age of the newest sample at the start of the tick (ns).
    pub sample_age_ns: u64,
    /// Index of the active state.
    pub state: u16,
    /// Status of the machine.
    pub status: Status,
    /// The pose of the platform.
    pub pose: Pose,
    /// Filtered base angles (rad), in the order of the policy's whiskers.
    pub base_angles: [f64; MAX_WHISKERS],
    /// Recorded tips (m, world frame).
    pub tips: [Option<[f64; 2]>; MAX_WHISKERS],
    /// The command.
    pub command: Command,
    /// True while the supervisor stops the robot. The machine has not been executed.
    pub is_paused: bool,
}
