//! A whisker as touches of a known object have measured it.

use serde::{Deserialize, Serialize};

use super::parameters::Parameter;
use crate::rig::Whisker;

/// A whisker as touches of a known object have measured it, with the covariance of its parameters.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MeasuredWhisker {
    /// Stiffness of the base hinge (N m/rad). It includes differences of the bending stiffness and of the sensor's gain.
    pub hinge_stiffness: f64,
    /// Length of the shaft (m).
    pub length: f64,
    /// Direction of the undeflected shaft at the base (rad, body frame).
    pub direction: f64,
    /// Position of the base (m, body frame).
    pub base: [f64; 2],
    /// Curvature of the shaft at rest (1/m), positive to its left.
    pub curvature: f64,
    /// Ratio of the radii at the tip and at the base.
    pub taper: f64,
    /// Reading of the whisker in the air (rad).
    pub offset: f64,
    /// Coefficient of friction of the whisker when it slides on the known object.
    pub friction: f64,
    /// Covariance of the parameters above, in this order. The friction is independent of the others. The first one is the relative stiffness.
    pub covariance: [[f64; Parameter::KEPT]; Parameter::KEPT],
}

impl MeasuredWhisker {
    /// Gives a whisker of the rig these properties.
    pub(crate) fn apply(&self, whisker: &mut Whisker) {
        whisker.hinge.stiffness = self.hinge_stiffness;
        whisker.shaft.length = self.length;
        whisker.direction_body = self.direction;
        whisker.base_body = self.base.into();
        whisker.shaft.curvature = self.curvature;
        whisker.shaft.tip_radius = Some(whisker.shaft.radius * self.taper);
    }

    /// True if all numbers are finite and in their valid ranges, and the variances are not negative.
    pub(super) fn is_sound(&self) -> bool {
        let numbers = [self.direction, self.curvature, self.offset];
        let covariance = &self.covariance;
        let is_covariance = covariance.iter().enumerate().all(|(row, values)| {
            values.iter().enumerate().all(|(column, value)| {
                let (variance, other) = (covariance[row][row], covariance[column][column]);
                value.is_finite()
                    && variance >= 0.0
                    && value.to_bits() == covariance[column][row].to_bits()
                    && value * value <= variance * other * (1.0 + 1e-9)
            })
        });
        numbers.iter().chain(&self.base).all(|number| number.is_finite())
            && (1e-6..=1e6).contains(&self.hinge_stiffness)
            && (1e-3..=1.0).contains(&self.length)
            && (0.01..=2.0).contains(&self.taper)
            && (0.0..=10.0).contains(&self.friction)
            && is_covariance
    }
}
