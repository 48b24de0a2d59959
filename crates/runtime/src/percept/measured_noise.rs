//! The noise of a whisker's readings, measured in free air.

use crate::math;
use crate::rig::Sensing;

/// The standard deviation of the noise of one whisker's readings.
///
/// The fourth difference of successive readings has hardly anything of the slower motions of a whisker. Its median
/// magnitude over a window is not affected by single outliers. Windows are averaged over some seconds.
#[derive(Debug, Clone)]
pub(super) struct MeasuredNoise {
    /// Standard deviation (rad) according to the rig.
    stated: f64,
    /// Newest readings (rad), oldest first, and their number since the last gap.
    readings: [f64; COEFFICIENTS.len()],
    count: usize,
    /// Magnitudes of the fourth differences in the current window (rad), and their number.
    magnitudes: [f64; WINDOW],
    filled: usize,
    /// Average variance of the windows (rad²), and the number of windows that it counts as.
    variance: f64,
    windows: f64,
}

/// Coefficients of the fourth difference, and the square root of the sum of their squares.
const COEFFICIENTS: [f64; 5] = [1.0, -4.0, 6.0, -4.0, 1.0];
const NORM: f64 = 8.366_600_265_340_756;
/// Number of differences in a window.
const WINDOW: usize = 31;
/// Median magnitude of a normal distribution with the standard deviation 1.
const NORMAL_MEDIAN: f64 = 0.674_489_750_196_081_7;
/// Relative standard deviation of the result of one window. It includes the correlation of successive differences.
const WINDOW_DEVIATION: f64 = 0.25;
/// Number of windows after which older ones are forgotten.
const REMEMBERED: f64 = 50.0;
/// Largest share by which one window counts more than the average: one with a vibration is no noise.
const MOST_GROWTH: f64 = 4.0;
/// Number of standard deviations by which a measured noise must differ from the stated one.
const SIGNIFICANT: f64 = 3.0;
/// Noise (rad) that has no effect on a contact.
const NEGLIGIBLE: f64 = 5e-8;

impl MeasuredNoise {
    /// Creates the measurement for whiskers with these sensors.
    pub(super) fn new(sensing: &Sensing) -> Self {
        Self {
            stated: sensing.reading_deviation(),
            readings: [0.0; COEFFICIENTS.len()],
            count: 0,
            magnitudes: [0.0; WINDOW],
            filled: 0,
            variance: 0.0,
            windows: 0.0,
        }
    }

    /// Adds a reading (rad) of the whisker in free air.
    pub(super) fn take(&mut self, reading: f64) {
        self.readings.rotate_left(1);
        self.readings[COEFFICIENTS.len() - 1] = reading;
        self.count = (self.count + 1).min(COEFFICIENTS.len());
        if self.count < COEFFICIENTS.len() {
            return;
        }
        let difference: f64 = self.readings.iter().zip(COEFFICIENTS).map(|(reading, factor)| reading * factor).sum();
        self.magnitudes[self.filled] = difference.abs() / NORM;
        self.filled += 1;
        if self.filled == WINDOW {
            self.filled = 0;
            self.magnitudes.sort_unstable_by(f64::total_cmp);
            self.add(math::square(self.magnitudes[WINDOW / 2] / NORMAL_MEDIAN));
        }
    }

    /// Adds the variance (rad²) of a window.
    fn add(&mut self, variance: f64) {
        let known = math::max(self.variance, math::square(math::max(self.stated, NEGLIGIBLE)));
        let variance = if self.windows > 0.0 { math::min(variance, MOST_GROWTH * known) } else { variance };
        self.windows = math::min(self.windows + 1.0, REMEMBERED);
        self.variance += (variance - self.variance) / self.windows;
    }

    /// Forgets the newest readings at a gap.
    pub(super) fn interrupt(&mut self) {
        self.count = 0;
    }

    /// The standard deviation (rad) of a reading: the stated one, unless the measured one is significantly larger.
    pub(super) fn value(&self) -> f64 {
        let measured = self.variance.sqrt();
        let deviation = WINDOW_DEVIATION / math::max(self.windows, 1.0).sqrt();
        let is_larger = measured * (1.0 - SIGNIFICANT * deviation) > math::max(self.stated, NEGLIGIBLE);
        if is_larger { measured } else { self.stated }
    }
}
