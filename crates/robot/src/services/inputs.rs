//! The inputs of a step of the control task, as a message.

use std::time::{SystemTime, UNIX_EPOCH};

use serde::{Deserialize, Serialize};

use crate::config::Config;
use crate::recording::{PoseMessage, RoundMessage};

/// The inputs of a step of the control task, as a message. Times are those of the sensor IO, in nanoseconds since its start.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Inputs {
    /// The run of the sensor IO.
    #[serde(flatten)]
    pub session: Session,
    /// Time of the message.
    pub sent_ns: u64,
    /// The last sample period of the step.
    pub last_slot: u64,
    /// Time of the sample period with the number 0.
    pub origin_ns: u64,
    /// The rounds since the last message.
    pub(super) rounds: Vec<RoundMessage>,
    /// The poses since the last message.
    pub(super) poses: Vec<PoseMessage>,
}

/// A run of the sensor IO.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Session {
    /// Its start by the system's clock (µs since 1970). Another value is another run.
    pub session: u64,
    /// Sample rate (Hz).
    pub sample_rate_hz: f64,
    /// Control rate (Hz).
    pub control_rate_hz: f64,
}

impl Session {
    /// A run that begins now.
    #[must_use]
    pub fn start(config: &Config) -> Self {
        // A clock before 1970 is not set.
        let time = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
        let sensing = &config.rig.sensing;
        Self {
            session: u64::try_from(time.as_micros()).unwrap_or(u64::MAX),
            sample_rate_hz: sensing.sample_rate,
            control_rate_hz: sensing.control_rate,
        }
    }
}
