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
    /// The offset (µrad) of whisker `i` at `2 i`, and its rate (µrad/s) at `2 i + 1`. Behind them is the effect of
    /// inertia.
    state: [f64; STATES],
    covariance: [[f64; STATES]; STATES],
    /// The newest readings of each whisker in free air, the oldest first. They are measurements only when the whisker is still
    /// free some ticks later, because a touch begins with small base angles.
    waiting: [[Option<FreeReading>; WAITING]; MAX_WHISKERS],
    /// True once an offset is known to differ from 0.
    is_known: bool,
}

/// The mean reading of a whisker in free air in one tick.
#[derive(Debug, Clone, Copy)]
pub(super) struct FreeReading {
    /// The reading (rad).
    pub(super) reading: f64,
    /// The base angle (rad) that is calculated for inertia.
    pub(super) bent: f64,
    /// Standard deviation (rad) of the noise.
    pub(super) deviation: f64,
}

/// Number of ticks for which a reading waits.
const WAITING: usize = 3;
const STATES: usize = 2 * MAX_WHISKERS + 1;
/// Standard deviation (µrad) of an offset at the start of a run.
const FIRST_OFFSET: f64 = 10.0;
/// Standard deviations (µrad/s) of the common rate and of the difference of a whisker's rate from it.
const COMMON_RATE: f64 = 0.3;
const OWN_RATE: f64 = 0.05;
/// Standard deviation of the effect of inertia over the calculated one, which is expected.
const INERTIA: f64 = 0.7;
/// Growth of the variance of these rates (µrad²/s³), which change within minutes.
const COMMON_CHANGE: f64 = 1e-4;
const OWN_CHANGE: f64 = 4e-6;
/// Growth of the variance of an offset (µrad²/s).
const WALK: f64 = 4e-4;
/// Standard deviation (µrad) of the mean reading of a tick in free air, because a whisker swings, and its share of the
/// effect of inertia. Both add to noise.
const SWING: f64 = 0.3;
const SWING_SHARE: f64 = 0.5;
/// Largest effect of inertia (µrad) for a measurement. A whisker swings after a larger one.
const MOST_BENT: f64 = 1.0;
/// Largest difference of a measured offset from the expected one, in standard deviations. A larger one is a touch.
const GATE: f64 = 4.0;
/// Offset (rad) that perception tolerates without a correction, and its standard deviations that make it significant. A
/// whisker that swings after the start of the platform has errors that are alike for some ticks.
pub(crate) const TOLERATED: f64 = 5e-7;
const SIGNIFICANT: f64 = 6.0;

const MICRO: f64 = 1e-6;

impl Offsets {
    /// Creates the offsets of so many whiskers, at most [`MAX_WHISKERS`].
    pub(super) fn new(count: usize) -> Self {
        let count = count.min(MAX_WHISKERS);
        let mut state = [0.0; STATES];
        state[2 * count] = 1.0;
        let mut covariance = [[0.0; STATES]; STATES];
        for (row, line) in covariance.iter_mut().enumerate() {
            for (column, value) in line.iter_mut().enumerate() {
                *value = match (row % 2, column % 2) {
                    _ if row >= 2 * count || column >= 2 * count => 0.0,
                    (0, 0) if row == column => math::square(FIRST_OFFSET),
                    (1, 1) if row == column => math::square(COMMON_RATE) + math::square(OWN_RATE),
                    (1, 1) => math::square(COMMON_RATE),
                    _ => 0.0,
                };
            }
        }
        covariance[2 * count][2 * count] = math::square(INERTIA);
        Self { count, state, covariance, waiting: [[None; WAITING]; MAX_WHISKERS], is_known: false }
    }

    /// The offset (rad) of a whisker, or 0 while none is significant.
    pub(super) fn value(&self, whisker: usize) -> f64 {
        if self.is_known { self.state[2 * whisker] * MICRO } else { 0.0 }
    }

    /// Standard deviation (rad) of the error of [`Self::value`]. An offset that is corrected is less and less known in contact.
    pub(super) fn deviation(&self, whisker: usize) -> f64 {
        let ignored = if self.is_known { 0.0 } else { self.state[2 * whisker] };
        math::hypot(ignored, math::max(self.covariance[2 * whisker][2 * whisker], 0.0).sqrt()) * MICRO
    }

    /// Continues the drift for `period` (s).
    pub(super) fn predict(&mut self, period: f64) {
        let states = 2 * self.count + 1;
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

    /// Adds the reading of a whisker in this tick. `None` for a whisker in contact.
    pub(super) fn add(&mut self, whisker: usize, reading: Option<FreeReading>) {
        let Some(waiting) = self.waiting.get_mut(whisker) else { return };
        let Some(reading) = reading else {
            *waiting = [None; WAITING];
            return;
        };
        let oldest = waiting[0];
        waiting.rotate_left(1);
        waiting[WAITING - 1] = Some(reading);
        if let Some(oldest) = oldest {
            let swing = swing(&oldest, waiting);
            self.measure(whisker, oldest, swing);
        }
    }

    /// Adds a reading of a whisker that swings with this amplitude (rad).
    fn measure(&mut self, whisker: usize, FreeReading { reading, bent, deviation }: FreeReading, swing: f64) {
        let (inertia, measured, bent) = (2 * self.count, 2 * whisker, bent / MICRO);
        if bent.abs() > MOST_BENT {
            return;
        }
        let column: [f64; STATES] =
            std::array::from_fn(|row| self.covariance[row][measured] + bent * self.covariance[row][inertia]);
        let variance = column[measured]
            + bent * column[inertia]
            + math::square(SWING)
            + math::square(SWING_SHARE * bent)
            + math::square(deviation / MICRO)
            + math::square(swing / MICRO);
        let innovation = reading / MICRO - self.state[measured] - bent * self.state[inertia];
        if math::square(innovation) > math::square(GATE) * variance {
            return;
        }
        for row in 0..=inertia {
            let gain = column[row] / variance;
            self.state[row] += gain * innovation;
            for (covariance, other) in self.covariance[row].iter_mut().zip(&column) {
                *covariance -= gain * other;
            }
        }
        let offset = self.state[measured].abs();
        self.is_known |= offset > TOLERATED / MICRO
            && math::square(offset) > math::square(SIGNIFICANT) * self.covariance[measured][measured];
    }
}

/// The amplitude (rad) of the swing of a whisker: half the range of a reading and of those after it. A long whisker swings for seconds
/// after it slipped off. Without the amplitude in its standard deviation, a small base angle would look like an offset.
fn swing(reading: &FreeReading, later: &[Option<FreeReading>]) -> f64 {
    let readings = later.iter().flatten().map(|later| later.reading - reading.reading);
    let (least, most) = readings
        .fold((0.0, 0.0), |(least, most), difference| (math::min(least, difference), math::max(most, difference)));
    (most - least) / 2.0
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use proptest::prelude::*;

    use super::super::robust_variance::tests::normals;
    use super::*;

    const PERIOD: f64 = 1.0 / 30.0;

    fn free(reading: f64, bent: f64, deviation: f64) -> FreeReading {
        FreeReading { reading, bent, deviation }
    }

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
                    offsets.add(0, Some(free(first + drift + noise * pair[0], 0.0, noise)));
                }
                offsets.add(1, Some(free(second + drift + noise * pair[1], 0.0, noise)));
                if tick > 150 && first.abs() + second.abs() > 2e-6 {
                    // The two had 5 s to differ.
                    prop_assert!((offsets.value(1) - second - drift).abs() < 3e-7, "{time} s");
                    // The readings of these 5 s determine a line, whose deviation at a later time follows from its slope's. The
                    // filter expects more noise than there is, so it lags by a part of the tolerated offset.
                    let deviation = noise * (12.0_f64 / 150.0).sqrt() * (time - 2.5) / 5.0;
                    let (most, error) = (5.0 * deviation + TOLERATED / 2.0, offsets.value(0) - first - drift);
                    prop_assert!(error.abs() < most, "{time} s: {error}");
                }
            }
        }

        #[test]
        fn in_contact_the_deviation_grows_and_covers_the_drift(
            first in -8e-6..8e-6_f64, rate in -4e-7..4e-7_f64, values in normals(300),
        ) {
            let mut offsets = Offsets::new(1);
            let drifted = |tick: usize| first + rate * PERIOD * f64::from(u32::try_from(tick).unwrap_or(0));
            for (tick, value) in values.into_iter().enumerate() {
                offsets.predict(PERIOD);
                offsets.add(0, Some(free(drifted(tick) + 2e-7 * value, 0.0, 2e-7)));
            }
            for tick in 300..2100 {
                let before = offsets.deviation(0);
                offsets.predict(PERIOD);
                offsets.add(0, None);
                // Without a significant offset, 0 is used, and the drift may come nearer to it.
                prop_assert!(offsets.value(0) == 0.0 || offsets.deviation(0) > before);
                let error = offsets.value(0) - drifted(tick);
                prop_assert!(error.abs() < 4.0 * offsets.deviation(0), "{error} rad, deviation {}", offsets.deviation(0));
            }
        }

        #[test]
        fn without_a_significant_offset_readings_are_not_changed(values in normals(2000)) {
            let mut offsets = Offsets::new(1);
            for value in values {
                offsets.predict(PERIOD);
                offsets.add(0, Some(free(1.5e-7 * value, 0.0, 1.5e-7)));
                prop_assert_eq!(offsets.value(0).to_bits(), 0.0_f64.to_bits());
            }
        }

        #[test]
        fn a_touch_is_no_offset(offset in -5e-6..5e-6_f64, touch in 3e-6..1.5e-5_f64) {
            let mut offsets = Offsets::new(1);
            for tick in 0..200 {
                offsets.predict(PERIOD);
                offsets.add(0, Some(free(offset + if tick < 170 { 0.0 } else { touch }, 0.0, 1e-7)));
            }
            prop_assert!((offsets.value(0) - offset).abs() < TOLERATED);
        }

        #[test]
        fn a_whisker_that_swings_is_no_offset(
            amplitude in 2e-6..2e-5_f64, frequency in 6.0..12.0_f64, decay in 0.5..3.0_f64, phase in 0.0..6.3_f64,
        ) {
            let mut offsets = Offsets::new(1);
            for tick in 0..300 {
                let time = PERIOD * f64::from(tick);
                offsets.predict(PERIOD);
                let reading = amplitude * math::exp(-time / decay) * math::cos(phase + TAU * frequency * time);
                // Perception takes a larger base angle for a touch.
                let free = reading.abs() < 1e-5;
                offsets.add(0, free.then(|| self::free(reading, 0.0, 1e-8)));
                prop_assert!(offsets.value(0).abs() < TOLERATED, "{time} s: {}", offsets.value(0));
            }
        }

        #[test]
        fn a_touch_that_begins_slowly_is_no_offset(first in -5e-6..5e-6_f64, rate in 2e-7..2e-6_f64, away in prop_oneof![Just(0), 0..400_u32]) {
            let mut offsets = Offsets::new(2);
            for whisker in [0, 1] {
                (0..90).for_each(|_| offsets.add(whisker, Some(free(first, 0.0, 1e-8))));
            }
            for _ in 0..away {
                offsets.predict(PERIOD);
                offsets.add(0, None);
            }
            let before = offsets.value(0);
            (1..4).for_each(|tick| offsets.add(0, Some(free(first + f64::from(tick) * rate, 0.0, 1e-8))));
            offsets.add(0, None);
            let after = offsets.value(0);
            if away == 0 {
                // The last readings in free air still waited, and are measured while the touch begins.
                prop_assert!((after - first).abs() <= (before - first).abs(), "from {before} to {after}, and not to {first}");
            } else {
                prop_assert_eq!(after.to_bits(), before.to_bits());
            }
        }

        #[test]
        fn whiskers_are_found_to_have_inertia_or_none(effect in 0.0..1.2_f64, offset in 2e-6..8e-6_f64, values in normals(600)) {
            let mut offsets = Offsets::new(2);
            for (tick, pair) in values.chunks(2).enumerate() {
                // The platform rotates in every second second.
                let bent = if tick / 30 % 2 == 0 { 2.5e-7 } else { 0.0 };
                offsets.predict(PERIOD);
                offsets.add(0, Some(free(offset + effect * bent + 1e-8 * pair[0], bent, 1e-8)));
                offsets.add(1, Some(free(-offset - effect * bent + 1e-8 * pair[1], -bent, 1e-8)));
            }
            prop_assert!((offsets.value(0) - offset).abs() < 1.2e-7, "{}", offsets.value(0) - offset);
            prop_assert!((offsets.value(1) + offset).abs() < 1.2e-7);
        }
    }
}
