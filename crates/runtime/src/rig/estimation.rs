//! The estimates of perception that correct what the rig states.

use serde::{Deserialize, Serialize};

/// Estimates that perception makes during a run. Each one can be switched off. All are on by default.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
#[expect(clippy::struct_excessive_bools, reason = "each of them is a key of the rig")]
pub struct Estimation {
    /// A contact survives some lost readings.
    pub lost_readings: bool,
    /// Offsets of base angles and their drift are measured in free air.
    pub offset: bool,
    /// Noise of base angles is measured in free air.
    pub noise: bool,
    /// Delays of poses and commands and the servos are measured, and compensated.
    pub delay: bool,
    /// The friction that a calibration has measured is assumed, unless the rig states one.
    pub friction: bool,
    /// Errors of measured poses are measured, and increase the uncertainty of contacts.
    pub pose_noise: bool,
}

impl Estimation {
    /// No estimate. Perception then believes what the rig states.
    pub const OFF: Self =
        Self { lost_readings: false, offset: false, noise: false, delay: false, friction: false, pose_noise: false };
}

impl Default for Estimation {
    fn default() -> Self {
        Self { lost_readings: true, offset: true, noise: true, delay: true, friction: true, pose_noise: true }
    }
}
