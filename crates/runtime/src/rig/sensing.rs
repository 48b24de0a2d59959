//! The sensors of a rig.

use serde::{Deserialize, Serialize};

use super::Estimation;
use crate::math;

/// Rates, noise and filters of the sensors.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Sensing {
    /// Sample rate (Hz).
    pub sample_rate: f64,
    /// Control rate (Hz). A tick has a whole number of samples.
    pub control_rate: f64,
    /// Standard deviation of the noise on a base angle (rad).
    pub angle_noise: f64,
    /// Resolution of a base angle (rad). 0 means continuous.
    pub angle_resolution: f64,
    /// Cutoff frequency of the low-pass filter for base angles (Hz).
    pub filter_cutoff: f64,
    /// Contact threshold: magnitude of the base angle above which a whisker counts as touching (rad).
    pub contact_threshold: f64,
    /// Coefficient of sliding friction that contact estimators assume. Objects have their own coefficient, in
    /// `Physics`.
    pub friction: f64,
    /// Standard deviation of surfaces about their outlines (m) that perception assumes, such as that of a texture.
    pub surface_roughness: f64,
    /// True if samples contain shear and axial force at each base.
    pub forces: bool,
    /// Standard deviation of the noise on each of these forces (N).
    pub force_noise: f64,
    /// Estimates that correct these values during a run.
    #[serde(default)]
    pub estimation: Estimation,
}

/// Standard deviation of the noise of the real sensor (rad), and its resolution (rad). Both are estimates without a
/// measurement.
///
/// The sensor's paper (Dang et al. 2025) keeps its whisker bent by a reading of 8760. They are assumed to be counts of
/// an MLX90393 at its highest sensitivity, 0.15 µT each. The baseline calls the same bend 300 µrad, so a count is 0.034
/// µrad. The chip's noise at 300 Hz is 1 to 2 µT, up to 13 counts.
const REAL_NOISE: f64 = 0.5e-6;
const REAL_RESOLUTION: f64 = 0.034e-6;
/// Standard deviation of the noise of a force sensor (N) as fine as that of base angles. Both are 1/600 of the value at
/// the target bend. No such sensor has been built.
const REAL_FORCE_NOISE: f64 = 2e-6;

impl Sensing {
    /// True if readings have noise.
    #[must_use]
    pub fn is_noisy(&self) -> bool {
        self.angle_noise > 0.0 || (self.forces && self.force_noise > 0.0)
    }

    /// Standard deviation (rad) of one reading of a base angle.
    #[must_use]
    pub fn reading_deviation(&self) -> f64 {
        math::hypot(self.angle_noise, self.angle_resolution / 12.0_f64.sqrt())
    }

    /// Sets noise and resolution to those of the real sensor.
    pub fn make_real(&mut self) {
        (self.angle_noise, self.angle_resolution) = (REAL_NOISE, REAL_RESOLUTION);
        self.force_noise = REAL_FORCE_NOISE;
    }
}

impl Default for Sensing {
    fn default() -> Self {
        Self {
            sample_rate: 300.0,
            control_rate: 30.0,
            angle_noise: 0.0,
            angle_resolution: 0.0,
            filter_cutoff: 20.0,
            contact_threshold: 2e-5,
            friction: 0.0,
            surface_roughness: 0.0,
            forces: false,
            force_noise: 0.0,
            estimation: Estimation::default(),
        }
    }
}
