//! The equilibrium base angle of a whisker, extrapolated from its newest readings.

use crate::math;
use crate::rig::{Sensing, Whisker};

use super::recent_line::RecentLine;

/// The equilibrium base angle of a whisker at the newest reading.
///
/// A straight line is fitted to the newest readings, over no more of them than their noise requires. The damping of the
/// hinge delays the base angle, so the line is extrapolated by this delay.
#[derive(Debug, Clone)]
pub(super) struct BaseAngle {
    /// Line through the newest readings (rad).
    line: RecentLine,
    /// Delay (s) of the base angle behind the base moment: damping over stiffness of the hinge.
    delay: f64,
    /// Standard deviation (rad).
    pub(super) deviation: f64,
    /// Standard deviation (rad) for filters that treat successive values as independent. Successive lines share
    /// readings, so many of their values together are no better than as many readings.
    pub(super) correlated_deviation: f64,
    /// Rate of the base angle (rad/s) above which the whisker is taken to move freely.
    calm_rate: f64,
    /// Smallest magnitude (rad) of the base angle of a contact: by the rig, and with the noise of the readings.
    least_threshold: f64,
    pub(super) contact_threshold: f64,
}

/// Standard deviation (rad) of effects outside of the model, such as vibrations of the shaft, as a base angle.
pub(crate) const MODEL_DEVIATION: f64 = 3e-7;
/// Standard deviation (rad) of the base angle up to which the line is lengthened.
const WANTED_DEVIATION: f64 = 4.5e-7;
/// Rate of the base angle (rad/s) above which the whisker is taken to move freely, and its standard deviations by which
/// noise raises this rate.
const CALM_RATE: (f64, f64) = (6e-4, 3.0);
/// Standard deviations of a base angle by which noise raises the contact threshold. One of a million readings of a
/// whisker in free air exceeds five.
pub(super) const NOISE_THRESHOLD: f64 = 5.0;

impl BaseAngle {
    /// Creates the estimate for `whisker`.
    pub(super) fn new(whisker: &Whisker, sensing: &Sensing) -> Self {
        let delay = whisker.hinge.damping / whisker.hinge.stiffness;
        let mut angle = Self {
            line: RecentLine::new(sensing.sample_rate.recip()),
            delay,
            deviation: 0.0,
            correlated_deviation: 0.0,
            calm_rate: CALM_RATE.0,
            least_threshold: sensing.contact_threshold,
            contact_threshold: sensing.contact_threshold,
        };
        angle.set_noise(sensing.reading_deviation());
        angle
    }

    /// Sets the standard deviation (rad) of the noise of a reading.
    pub(super) fn set_noise(&mut self, noise: f64) {
        self.line.fit_to(self.delay, noise, WANTED_DEVIATION);
        let gain = self.line.noise_gain(self.delay);
        let deviation = |gain: f64| math::hypot(MODEL_DEVIATION, noise * gain);
        (self.deviation, self.correlated_deviation) = (deviation(gain), deviation(math::max(gain, 1.0)));
        self.calm_rate = math::max(CALM_RATE.0, CALM_RATE.1 * noise * self.line.slope_gain());
        self.contact_threshold = math::max(self.least_threshold, NOISE_THRESHOLD * self.deviation);
    }

    /// Adds a reading (rad).
    pub(super) fn take(&mut self, base_angle: f64) {
        self.line.take(base_angle);
    }

    /// Forgets all readings.
    pub(super) fn clear(&mut self) {
        self.line.clear();
    }

    /// Returns the base angle (rad), and true if it changes slowly enough for a whisker in contact.
    pub(super) fn value(&self) -> (f64, bool) {
        let (value, rate) = self.line.at(self.delay);
        (value, rate.abs() < self.calm_rate)
    }
}
