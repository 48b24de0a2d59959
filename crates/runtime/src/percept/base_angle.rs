//! The base angle of a whisker as it is now, by its newest readings.

use crate::rig::{Sensing, Whisker};

use super::recent_line::RecentLine;

/// The base angle that a whisker would have in equilibrium, by a straight line through its newest readings, no longer than their noise
/// asks for. The hinge's damping delays it; the line is read that much ahead.
#[derive(Debug, Clone)]
pub(super) struct BaseAngle {
    line: RecentLine,
    /// Time by which the base angle is behind the base moment (s): the hinge's damping over its stiffness.
    delay: f64,
    /// Standard deviation (rad).
    pub(super) deviation: f64,
    /// The same for who takes one value after the other to be off by chance: as lines have readings in common, many of their values
    /// together are no better than as many readings.
    pub(super) correlated_deviation: f64,
}

/// Standard deviation (rad) of what the mechanics leave out, such as the shaft's own swing, as a base angle.
const MODEL_DEVIATION: f64 = 3e-7;
/// The spread of the base angle (rad) that is worth a longer line through the readings.
const WANTED_DEVIATION: f64 = 4.5e-7;
/// A base angle that changes faster (rad/s) is that of a whisker in free motion.
const CALM_RATE: f64 = 6e-4;

impl BaseAngle {
    pub(super) fn new(whisker: &Whisker, sensing: &Sensing) -> Self {
        let delay = whisker.hinge.damping / whisker.hinge.stiffness;
        let noise = sensing.angle_noise.hypot(sensing.angle_resolution / 12.0_f64.sqrt());
        let line = RecentLine::new(sensing.sample_rate.recip(), delay, noise, WANTED_DEVIATION);
        let gain = line.noise_gain(delay);
        let deviation = |gain: f64| MODEL_DEVIATION.hypot(noise * gain);
        Self { deviation: deviation(gain), correlated_deviation: deviation(gain.max(1.0)), delay, line }
    }

    /// Takes a reading (rad).
    pub(super) fn take(&mut self, base_angle: f64) {
        self.line.take(base_angle);
    }

    /// Forgets all readings.
    pub(super) fn clear(&mut self) {
        self.line.clear();
    }

    /// The base angle (rad), and whether it changes no faster than that of a whisker which touches.
    pub(super) fn value(&self) -> (f64, bool) {
        let (value, rate) = self.line.at(self.delay);
        (value, rate.abs() < CALM_RATE)
    }
}
