//! The calibration of a whisker: contacts at known positions, and functions fitted to them.

mod angle_surface;
mod contact_curve;
mod contact_set;
mod deflection_polynomial;
mod free_motion;
mod least_squares;
mod measured_whisker;
mod parameters;
mod refusal;
mod touch_fit;
mod touch_plan;
#[cfg(test)]
mod touch_tests;
mod workspace;

use serde::{Deserialize, Serialize};

use crate::rig::Whisker;

pub use angle_surface::AngleSurface;
pub use contact_curve::ContactCurve;
pub use contact_set::ContactSet;
pub use deflection_polynomial::DeflectionPolynomial;
pub use free_motion::FreeMotion;
pub use measured_whisker::MeasuredWhisker;
pub use parameters::{Parameter, ParameterCovariance, Parameters, tolerances};
pub use refusal::TouchRefusal;
pub use touch_fit::{Stroke, TouchFit, TouchNoise, TouchReading};
pub use touch_plan::{PlannedTouch, TouchPlan};

/// Measured properties of a whisker. Perception derives missing ones from the mechanics.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Calibration {
    /// A description of the measurement, for people.
    pub about: String,
    /// Stiffness of the base hinge (N m/rad).
    pub hinge_stiffness: Option<f64>,
    /// The whisker as touches of a known object have measured it. Then `hinge_stiffness` is `None`.
    pub measured: Option<MeasuredWhisker>,
    /// The motion in the air, if it was measured.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub free_motion: Option<FreeMotion>,
    /// The contact position by base angle, for the contact estimator `one_channel`.
    pub one_channel: Option<ContactCurve>,
    /// The base angle by contact position, for the contact estimator `recursive`.
    pub recursive: Option<AngleSurface>,
    /// The tip position by base angle, for the contact estimator `polynomial`.
    pub polynomial: Option<DeflectionPolynomial>,
}

/// A value of a calibration that cannot be used.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error(
    "`{key}` cannot be used: a number is not finite, a range is empty, a variance is negative, or a value is given twice; calibrate again"
)]
pub struct UnsoundCalibration {
    /// The key of the value.
    pub key: &'static str,
}

impl Calibration {
    /// A calibration without values.
    #[must_use]
    pub fn new(about: String) -> Self {
        Self { about, ..Self::default() }
    }

    /// The calibration of a whisker that nothing has touched: the rig with the tolerances of manufacture.
    #[must_use]
    pub fn untouched(whisker: &Whisker) -> Self {
        let measured = Some(TouchFit::untouched(whisker).measured());
        Self { measured, ..Self::new("the tolerances of manufacture".to_owned()) }
    }

    /// Checks that perception can use every value.
    ///
    /// # Errors
    /// [`UnsoundCalibration`] with the key of the first value that it cannot use.
    pub fn check(&self) -> Result<(), UnsoundCalibration> {
        let checks = [
            ("hinge_stiffness", self.hinge_stiffness.is_none_or(|stiffness| (1e-6..=1e6).contains(&stiffness))),
            ("hinge_stiffness", self.hinge_stiffness.is_none() || self.measured.is_none()),
            ("measured", self.measured.as_ref().is_none_or(MeasuredWhisker::is_sound)),
            ("free_motion", self.free_motion.as_ref().is_none_or(FreeMotion::is_sound)),
            ("one_channel", self.one_channel.as_ref().is_none_or(ContactCurve::is_sound)),
            ("recursive", self.recursive.as_ref().is_none_or(AngleSurface::is_sound)),
            ("polynomial", self.polynomial.as_ref().is_none_or(DeflectionPolynomial::is_sound)),
        ];
        match checks.iter().find(|(_, sound)| !sound) {
            Some((key, _)) => Err(UnsoundCalibration { key }),
            None => Ok(()),
        }
    }
}
