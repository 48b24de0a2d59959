//! The faults that stop a robot.

use std::fmt;

use serde::{Deserialize, Serialize};

use crate::config::FaultResponse;

vibrissa_runtime::kinds! {
    /// The kinds of faults.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
    #[serde(rename_all = "snake_case")]
    pub enum FaultKind,
    /// The name of the kind in files and messages.
    fn name {
        /// A sensor answers, but has no new value.
        SensorStale = "sensor_stale",
        /// A sensor does not answer, or has lost its mode. Its bring-up is tried again.
        SensorLost = "sensor_lost",
        /// A reading has no base angle, a pose is not a number or absurd, or a status byte is impossible.
        InvalidReading = "invalid_reading",
        /// A field is at the end of the sensor's range, or beyond it.
        Saturated = "saturated",
        /// A base angle exceeds its limit.
        AngleLimit = "angle_limit",
        /// A bus has completed no round. A call may be blocked.
        BusBlocked = "bus_blocked",
        /// The last pose is too old.
        PoseOld = "pose_old",
        /// A pose is farther from the last one than the platform can have moved. It is not taken.
        PoseJump = "pose_jump",
        /// The localisation has begun a new sequence.
        PoseRestarted = "pose_restarted",
        /// A packet has come to the port of the poses from another sender. It is not read.
        ForeignSender = "foreign_sender",
        /// The actuator acknowledges no recent command.
        LinkLost = "link_lost",
        /// The MQTT broker is gone. Only telemetry needs it.
        BrokerGone = "broker_gone",
        /// The control loop has not completed a tick in time.
        ControlLate = "control_late",
        /// The machine has failed.
        MachineFailed = "machine_failed",
        /// A thread has panicked.
        Panic = "panic",
        /// The system has asked the program to end.
        Terminated = "terminated",
    }
}

impl FaultKind {
    /// The response to a fault of this kind, unless the configuration has another one.
    #[must_use]
    pub fn default_response(self) -> FaultResponse {
        match self {
            Self::BrokerGone | Self::ForeignSender => FaultResponse::Log,
            Self::SensorStale
            | Self::SensorLost
            | Self::InvalidReading
            | Self::Saturated
            | Self::BusBlocked
            | Self::PoseOld
            | Self::PoseJump
            | Self::PoseRestarted
            | Self::LinkLost
            | Self::ControlLate => FaultResponse::Pause,
            Self::AngleLimit | Self::MachineFailed | Self::Panic | Self::Terminated => FaultResponse::Stop,
        }
    }
}

/// A fault and its cause.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Fault {
    /// Its kind.
    pub kind: FaultKind,
    /// Index of the bus or whisker that has it. 0 for other kinds.
    pub part: u8,
}

impl fmt::Display for Fault {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let part = self.part;
        match self.kind {
            FaultKind::SensorStale => write!(formatter, "the sensor of whisker {part} has no new value"),
            FaultKind::SensorLost => {
                write!(formatter, "the sensor of whisker {part} does not answer, or has lost its mode")
            }
            FaultKind::InvalidReading => {
                write!(
                    formatter,
                    "a reading of whisker {part} has no base angle, a pose is not a number or absurd, or a status byte is impossible"
                )
            }
            FaultKind::Saturated => {
                write!(formatter, "the field at whisker {part} is at the end of the sensor's range, or beyond it")
            }
            FaultKind::AngleLimit => write!(formatter, "the base angle of whisker {part} exceeds its limit"),
            FaultKind::BusBlocked => write!(formatter, "bus {part} completes no round"),
            FaultKind::PoseOld => formatter.write_str("the last pose is too old"),
            FaultKind::PoseJump => {
                formatter.write_str("a pose is farther from the last one than the platform can have moved")
            }
            FaultKind::PoseRestarted => formatter.write_str("the localisation has begun a new sequence"),
            FaultKind::ForeignSender => {
                formatter.write_str("a packet for the poses has come from a sender that `from` does not name")
            }
            FaultKind::LinkLost => formatter.write_str("the actuator acknowledges no recent command"),
            FaultKind::BrokerGone => formatter.write_str("the MQTT broker does not answer"),
            FaultKind::ControlLate => formatter.write_str("the control loop has not completed a tick in time"),
            FaultKind::MachineFailed => formatter.write_str("the machine has failed"),
            FaultKind::Panic => formatter.write_str("a thread has panicked"),
            FaultKind::Terminated => formatter.write_str("the system has asked the program to end"),
        }
    }
}

/// A change of a fault.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct FaultEvent {
    /// Time since the start of the program (ns).
    pub time_ns: u64,
    /// The fault.
    pub fault: Fault,
    /// The change.
    pub change: FaultChange,
}

/// The changes of a fault.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum FaultChange {
    /// The fault has begun, as the supervisor sees it.
    Detected,
    /// The first stop command after it has been sent.
    Reacted,
    /// The fault is over, and the loop has resumed if it was stopped.
    Recovered,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_kind_is_explained_and_has_a_remedy_in_the_book() {
        let page = include_str!("../../../docs/raspberry-pi.md");
        let (faults, troubleshooting) = page.split_once("## Troubleshooting").unwrap_or_default();
        for name in FaultKind::ALL.map(FaultKind::name) {
            assert!(faults.contains(&format!("\n| `{name}`: ")), "{name} has no row in the section Faults");
            assert!(troubleshooting.contains(&format!("\n| `{name}` ")), "{name} has no row in Troubleshooting");
        }
    }
}
