//! The noise of a whisker's readings, measured in free air.

use crate::math;
use crate::rig::Sensing;

use super::robust_variance::RobustVariance;

/// The standard deviation of the noise of one whisker's readings.
///
/// The fourth difference of successive readings has hardly anything of the slower motions of a whisker.
#[derive(Debug, Clone)]
pub(super) struct MeasuredNoise {
    /// Standard deviation (rad) according to the rig.
    stated: f64,
    /// Newest readings (rad), oldest first, and their number since the last gap.
    readings: [f64; COEFFICIENTS.len()],
    count: usize,
    /// Variance of the fourth differences (rad²) for independent readings with the variance 1.
    variance: RobustVariance,
}

/// Coefficients of the fourth difference, and the square root of the sum of their squares.
const COEFFICIENTS: [f64; 5] = [1.0, -4.0, 6.0, -4.0, 1.0];
const NORM: f64 = 8.366_600_265_340_756;
/// Noise (rad) that has no effect on a contact.
const NEGLIGIBLE: f64 = 5e-8;

impl MeasuredNoise {
    /// Creates the measurement for whiskers with these sensors.
    pub(super) fn new(sensing: &Sensing) -> Self {
        let stated = sensing.reading_deviation();
        let variance = RobustVariance::new(math::max(stated, NEGLIGIBLE));
        Self { stated, readings: [0.0; COEFFICIENTS.len()], count: 0, variance }
    }

    /// Adds a reading (rad) of the whisker in free air.
    pub(super) fn take(&mut self, reading: f64) {
        self.readings.rotate_left(1);
        self.readings[COEFFICIENTS.len() - 1] = reading;
        self.count = (self.count + 1).min(COEFFICIENTS.len());
        if self.count == COEFFICIENTS.len() {
            let weighted = self.readings.iter().zip(COEFFICIENTS).map(|(reading, factor)| reading * factor);
            self.variance.take(weighted.sum::<f64>() / NORM);
        }
    }

    /// Forgets the newest readings at a gap.
    pub(super) fn interrupt(&mut self) {
        self.count = 0;
    }

    /// The standard deviation (rad) of a reading: the stated one, unless the measured one is significantly larger.
    pub(super) fn value(&self) -> f64 {
        self.variance.beyond(math::max(self.stated, NEGLIGIBLE)).unwrap_or(self.stated)
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use proptest::prelude::*;

    use super::super::robust_variance::tests::normals;
    use super::*;
    use crate::rig::Rig;

    /// The measured noise after readings at 300 Hz.
    fn measured(readings: impl IntoIterator<Item = f64>) -> f64 {
        let mut noise = MeasuredNoise::new(&Rig::default().sensing);
        readings.into_iter().for_each(|reading| noise.take(reading));
        noise.value()
    }

    proptest! {
        #[test]
        fn noise_is_found_in_spite_of_a_swing_and_single_touches(
            values in normals(1500), exponent in -6.5..-5.0_f64, swing in 0.0..1e-5_f64, frequency in 1.0..20.0_f64,
        ) {
            let deviation = math::powf(10.0, exponent);
            let readings = values.iter().enumerate().map(|(index, value)| {
                let touch = if index % 100 == 50 { 1e-4 } else { 0.0 };
                swing * math::sin(index as f64 / 300.0 * frequency * TAU) + touch + deviation * value
            });
            let found = measured(readings);
            prop_assert!((0.75..1.4).contains(&(found / deviation)), "{found} {deviation}");
        }

        #[test]
        fn exact_readings_have_the_stated_noise(swing in 0.0..1e-5_f64, frequency in 0.1..15.0_f64) {
            let readings = (0..1500).map(|index| swing * math::sin(f64::from(index) / 300.0 * frequency * TAU));
            prop_assert_eq!(measured(readings).to_bits(), 0.0_f64.to_bits());
        }
    }
}
