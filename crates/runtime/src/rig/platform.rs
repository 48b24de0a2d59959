//! The platform and its servos.

use nalgebra::{Point2, Vector3};
use serde::{Deserialize, Serialize};

use crate::math;

/// Least width of the nose in the outline (m), because a side without length has no normal. The simulators' own
/// tolerances for contacts are larger.
const NARROWEST: f64 = 1e-5;

/// The body that carries the whiskers. Its footprint is a trapezoid that is symmetric about its axis.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Platform {
    /// Width at the tail (m).
    pub tail_width: f64,
    /// Width at the nose (m). 0 for a point.
    pub nose_width: f64,
    /// Length from tail to nose (m).
    pub length: f64,
    /// Distance of the centre of mass ahead of the tail (m).
    pub centre_of_mass: f64,
    /// Mass (kg).
    pub mass: f64,
    /// Moment of inertia about the vertical through the centre of mass (kg m²).
    pub inertia: f64,
    /// Time constant of the first-order response of the servos to a commanded velocity (s).
    pub servo: f64,
    /// Time constant of their response to a commanded yaw rate (s). `None` if it is the same.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub yaw_servo: Option<f64>,
    /// Speed limit of the centre of mass (m/s). No command exceeds it.
    pub speed_limit: f64,
    /// Yaw rate limit (rad/s). No command exceeds it.
    pub yaw_rate_limit: f64,
    /// The yaw controller.
    pub yaw: YawController,
}

impl Platform {
    /// Time constants of the servos (s): x, y, yaw.
    #[must_use]
    pub fn servos(&self) -> Vector3<f64> {
        Vector3::new(self.servo, self.servo, self.yaw_servo.unwrap_or(self.servo))
    }

    /// The corners in the body frame (m), counter-clockwise from the right end of the tail. They are distinct, also if
    /// the nose is a point.
    #[must_use]
    pub fn outline_body(&self) -> [Point2<f64>; 4] {
        let (tail, nose) = (-self.centre_of_mass, self.length - self.centre_of_mass);
        let (tail_side, nose_side) = (0.5 * self.tail_width, 0.5 * math::max(self.nose_width, NARROWEST));
        [
            Point2::new(tail, -tail_side),
            Point2::new(nose, -nose_side),
            Point2::new(nose, nose_side),
            Point2::new(tail, tail_side),
        ]
    }
}

impl Default for Platform {
    fn default() -> Self {
        Self {
            tail_width: 0.12,
            nose_width: 0.03,
            length: 0.18,
            centre_of_mass: 0.072,
            mass: 0.51,
            inertia: 0.0015,
            servo: 0.05,
            yaw_servo: None,
            speed_limit: 1.0,
            yaw_rate_limit: std::f64::consts::PI,
            yaw: YawController::default(),
        }
    }
}

/// Gains of the yaw controller, a limited PI controller that rotates the platform to a heading.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct YawController {
    /// Yaw rate per error of the heading (1/s).
    pub proportional: f64,
    /// Growth of the yaw rate per error of the heading (1/s²).
    pub integral: f64,
    /// Largest yaw rate of its output (rad/s).
    pub limit: f64,
}

impl Default for YawController {
    fn default() -> Self {
        Self { proportional: 2.0, integral: 0.8, limit: std::f64::consts::FRAC_PI_4 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_outline_runs_counter_clockwise_about_the_centre_of_mass() {
        let outline = Platform::default().outline_body();
        let area: f64 = (0..4).map(|corner| outline[corner].coords.perp(&outline[(corner + 1) % 4].coords) / 2.0).sum();
        assert!((area - 0.18 * (0.12 + 0.03) / 2.0).abs() < 1e-12);
        assert!((outline[1].x - outline[0].x - 0.18).abs() < 1e-12 && (outline[0].x + 0.072).abs() < 1e-12);
    }
}
