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
}

/// Standard deviation (rad) of effects outside of the model, such as vibrations of the shaft, as a base angle.
const MODEL_DEVIATION: f64 = 3e-7;
/// Standard deviation (rad) of the base angle up to which the line is lengthened.
const WANTED_DEVIATION: f64 = 4.5e-7;
/// Rate of the base angle (rad/s) above which the whisker is taken to move freely.
const CALM_RATE: f64 = 6e-4;

impl BaseAngle {
    /// Creates the estimate for `whisker`.
    pub(super) fn new(whisker: &Whisker, sensing: &Sensing) -> Self {
        let delay = whisker.hinge.damping / whisker.hinge.stiffness;
        let noise = math::hypot(sensing.angle_noise, sensing.angle_resolution / 12.0_f64.sqrt());
        let line = RecentLine::new(sensing.sample_rate.recip(), delay, noise, WANTED_DEVIATION);
        let gain = line.noise_gain(delay);
        let deviation = |gain: f64| math::hypot(MODEL_DEVIATION, noise * gain);
        Self { deviation: deviation(gain), correlated_deviation: deviation(math::max(gain, 1.0)), delay, line }
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
        (value, rate.abs() < CALM_RATE)
    }
}
