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
const TOLERATED: f64 = 3e-7;
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

    /// Adds the mean reading (rad) of a whisker in free air. `deviation` (rad) is the standard deviation of its noise.
    pub(super) fn measure(&mut self, whisker: usize, reading: f64, deviation: f64) {
        let (states, measured) = (2 * self.count, 2 * whisker);
        let variance = self.covariance[measured][measured] + math::square(SWING) + math::square(deviation / MICRO);
        let innovation = reading / MICRO - self.state[measured];
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
