//! Offsets of base angles and their drift, from whiskers in free air.

use crate::math;
use crate::signal::MAX_WHISKERS;

/// The offsets of the readings of all whiskers, which drift.
///
/// A Kalman filter has the offset of each whisker and its rate as states. The reading of a whisker in free air is a
/// measurement of its offset. The rates have a common part, for example due to temperature. So a whisker in contact gets
/// the drift of those in free air.
#[derive(Debug, Clone)]
pub(super) struct Offsets {
    /// Number of whiskers.
    count: usize,
    /// The offset (µrad) of whisker `i` at `2 i`, and its rate (µrad/s) at `2 i + 1`.
    state: [f64; STATES],
    covariance: [[f64; STATES]; STATES],
    /// True once an offset is known to differ from 0.
    is_known: bool,
}

const STATES: usize = 2 * MAX_WHISKERS;
/// Standard deviation (µrad) of an offset at the start of a run.
const FIRST_OFFSET: f64 = 10.0;
/// Standard deviations (µrad/s) of the common rate and of the difference of a whisker's rate from it.
const COMMON_RATE: f64 = 0.3;
const OWN_RATE: f64 = 0.05;
/// Growth of the variance of these rates (µrad²/s³), which change within minutes.
const COMMON_CHANGE: f64 = 1e-4;
const OWN_CHANGE: f64 = 4e-6;
/// Growth of the variance of an offset (µrad²/s).
const WALK: f64 = 4e-4;
/// Standard deviation (µrad) of the mean reading of a tick in free air, because a whisker swings. It adds to noise.
const SWING: f64 = 0.3;
/// Largest difference of a measured offset from the expected one, in standard deviations. A larger one is a touch.
const GATE: f64 = 4.0;
/// Offset (rad) that perception tolerates without a correction, and its standard deviations that make it significant.
pub(super) const TOLERATED: f64 = 3e-7;
const SIGNIFICANT: f64 = 3.0;

const MICRO: f64 = 1e-6;

impl Offsets {
    /// Creates the offsets of so many whiskers, at most [`MAX_WHISKERS`].
    pub(super) fn new(count: usize) -> Self {
        let mut covariance = [[0.0; STATES]; STATES];
        for (row, line) in covariance.iter_mut().enumerate() {
            for (column, value) in line.iter_mut().enumerate() {
                *value = match (row % 2, column % 2) {
                    (0, 0) if row == column => math::square(FIRST_OFFSET),
                    (1, 1) if row == column => math::square(COMMON_RATE) + math::square(OWN_RATE),
                    (1, 1) => math::square(COMMON_RATE),
                    _ => 0.0,
                };
            }
        }
        Self { count: count.min(MAX_WHISKERS), state: [0.0; STATES], covariance, is_known: false }
    }

    /// The offset (rad) of a whisker, or 0 while none is significant.
    pub(super) fn value(&self, whisker: usize) -> f64 {
        if self.is_known { self.state[2 * whisker] * MICRO } else { 0.0 }
    }

    /// Continues the drift for `period` (s).
    pub(super) fn predict(&mut self, period: f64) {
        let states = 2 * self.count;
        for whisker in 0..self.count {
            self.state[2 * whisker] += self.state[2 * whisker + 1] * period;
            for column in 0..states {
                self.covariance[2 * whisker][column] += self.covariance[2 * whisker + 1][column] * period;
            }
        }
        for row in 0..states {
            for whisker in 0..self.count {
                self.covariance[row][2 * whisker] += self.covariance[row][2 * whisker + 1] * period;
            }
        }
        for row in 0..self.count {
            self.covariance[2 * row][2 * row] += WALK * period;
            self.covariance[2 * row + 1][2 * row + 1] += OWN_CHANGE * period;
            for column in 0..self.count {
                self.covariance[2 * row + 1][2 * column + 1] += COMMON_CHANGE * period;
            }
        }
    }

    /// Adds a measured offset (rad) of a whisker in free air with its standard deviation (rad).
    pub(super) fn measure(&mut self, whisker: usize, offset: f64, deviation: f64) {
        let (states, measured) = (2 * self.count, 2 * whisker);
        let variance = self.covariance[measured][measured] + math::square(SWING) + math::square(deviation / MICRO);
        let innovation = offset / MICRO - self.state[measured];
        if math::square(innovation) > math::square(GATE) * variance {
            return;
        }
        let column: [f64; STATES] = std::array::from_fn(|row| self.covariance[row][measured]);
        for row in 0..states {
            let gain = column[row] / variance;
            self.state[row] += gain * innovation;
            for other in 0..states {
                self.covariance[row][other] -= gain * column[other];
            }
        }
        let offset = self.state[measured].abs();
        self.is_known |= offset > TOLERATED / MICRO
            && math::square(offset) > math::square(SIGNIFICANT) * self.covariance[measured][measured];
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::super::robust_variance::tests::normals;
    use super::*;

    const PERIOD: f64 = 1.0 / 30.0;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(60))]

        #[test]
        fn a_whisker_in_contact_has_the_drift_of_one_in_free_air(
            first in -8e-6..8e-6_f64, second in -8e-6..8e-6_f64, rate in -4e-7..4e-7_f64, values in normals(4200),
        ) {
            let mut offsets = Offsets::new(2);
            for (tick, pair) in values.chunks(2).enumerate() {
                let time = PERIOD * f64::from(u32::try_from(tick).unwrap_or(0));
                offsets.predict(PERIOD);
                let (noise, drift) = (2e-7, rate * time);
                if time < 5.0 {
                    offsets.measure(0, first + drift + noise * pair[0], noise);
                }
                offsets.measure(1, second + drift + noise * pair[1], noise);
                if tick > 150 && first.abs() + second.abs() > 2e-6 {
                    // The two had 5 s to differ.
                    prop_assert!((offsets.value(1) - second - drift).abs() < 3e-7, "{time} s");
                    prop_assert!((offsets.value(0) - first - drift).abs() < 2.5e-6, "{time} s: {}", offsets.value(0) - first - drift);
                }
            }
        }

        #[test]
        fn without_a_significant_offset_readings_are_not_changed(values in normals(2000)) {
            let mut offsets = Offsets::new(1);
            for value in values {
                offsets.predict(PERIOD);
                offsets.measure(0, 1.5e-7 * value, 1.5e-7);
                prop_assert_eq!(offsets.value(0).to_bits(), 0.0_f64.to_bits());
            }
        }

        #[test]
        fn a_touch_is_no_offset(offset in -5e-6..5e-6_f64, touch in 3e-6..1.5e-5_f64) {
            let mut offsets = Offsets::new(1);
            for tick in 0..200 {
                offsets.predict(PERIOD);
                offsets.measure(0, offset + if tick < 170 { 0.0 } else { touch }, 1e-7);
            }
            prop_assert!((offsets.value(0) - offset).abs() < 4e-7);
        }
    }
}
