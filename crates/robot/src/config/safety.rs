//! The sections `limits`, `timeouts` and `faults`.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::quantity;
use crate::fault::FaultKind;

/// Limits that no command and no valid reading exceeds.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Limits {
    /// Largest speed of a command (m/s).
    #[serde(with = "quantity::speed")]
    pub speed: f64,
    /// Largest yaw rate of a command (rad/s).
    #[serde(with = "quantity::angular_speed")]
    pub yaw_rate: f64,
    /// Largest base angle (rad). A whisker with a larger one may break.
    #[serde(default = "baseline_angle", with = "quantity::angle")]
    pub base_angle: f64,
}

impl Limits {
    /// Limits of a speed (m/s) and a yaw rate (rad/s), with the default limit of base angles.
    #[must_use]
    pub fn new(speed: f64, yaw_rate: f64) -> Self {
        Self { speed, yaw_rate, base_angle: baseline_angle() }
    }
}

/// Beyond the angles that policies allow, and within the range of the sensor with the baseline's magnet, 1.1 mrad.
fn baseline_angle() -> f64 {
    1.05e-3
}

/// Times without a sign of life after which a part has failed (s).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Timeouts {
    /// Since the last round on a bus.
    #[serde(with = "quantity::time")]
    pub bus: f64,
    /// Since the last new value of a sensor.
    #[serde(with = "quantity::time")]
    pub sensor: f64,
    /// Since the last pose.
    #[serde(with = "quantity::time")]
    pub pose: f64,
    /// Since the last tick of the control loop.
    #[serde(with = "quantity::time")]
    pub control: f64,
    /// Since the newest acknowledged command was sent.
    #[serde(with = "quantity::time")]
    pub link: f64,
    /// Time without a fault before the loop resumes.
    #[serde(with = "quantity::time")]
    pub settle: f64,
}

impl Timeouts {
    /// The timeout of poses (ns).
    #[must_use]
    pub fn pose_ns(&self) -> u64 {
        ns(self.pose)
    }

    /// The timeout of the control loop (ns).
    #[must_use]
    pub fn control_ns(&self) -> u64 {
        ns(self.control)
    }
}

/// Nanoseconds of a time (s).
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "`as` saturates")]
fn ns(seconds: f64) -> u64 {
    (seconds * 1e9) as u64
}

impl Default for Timeouts {
    fn default() -> Self {
        Self { bus: 0.04, sensor: 0.04, pose: 0.06, control: 0.07, link: 0.08, settle: 0.12 }
    }
}

/// The response to a fault.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum FaultResponse {
    /// Log the fault and go on.
    Log,
    /// Stop while the fault lasts, and resume after it.
    Pause,
    /// Stop, and stay stopped until the program is started again.
    #[default]
    Stop,
}

/// The responses to faults. A kind that is not listed has its own default.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Responses(BTreeMap<FaultKind, FaultResponse>);

impl Responses {
    /// The response to a fault of this kind.
    #[must_use]
    pub fn to(&self, kind: FaultKind) -> FaultResponse {
        self.0.get(&kind).copied().unwrap_or_else(|| kind.default_response())
    }

    /// Sets the response to a kind of fault.
    pub fn set(&mut self, kind: FaultKind, response: FaultResponse) {
        self.0.insert(kind, response);
    }
}
