//! The neutral value of a whisker.

use thiserror::Error;

/// A running estimate of the counts of a whisker at rest.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Zero {
    needed: u32,
    largest_spread_counts: u32,
    measurements: u32,
    sum_counts: i64,
    lowest_counts: i32,
    highest_counts: i32,
}

/// Counts that vary more than noise does.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[error(
    "the counts vary by {spread_counts}, more than {largest_spread_counts}. Keep the whisker still and free, and measure the zero again"
)]
pub(super) struct Moving {
    /// Difference between the highest and the lowest counts.
    spread_counts: u32,
    /// The largest permitted difference.
    largest_spread_counts: u32,
}

impl Zero {
    /// An estimate that needs this many measurements, at least one, and permits this difference between the highest and the
    /// lowest.
    pub(super) fn new(measurements: u32, largest_spread_counts: u32) -> Self {
        Self {
            needed: measurements.max(1),
            largest_spread_counts,
            measurements: 0,
            sum_counts: 0,
            lowest_counts: i32::MAX,
            highest_counts: i32::MIN,
        }
    }

    /// Adds a measurement. Measurements beyond the needed number are included too.
    pub(super) fn add(&mut self, counts: i32) {
        self.measurements = self.measurements.saturating_add(1);
        self.sum_counts = self.sum_counts.saturating_add(i64::from(counts));
        self.lowest_counts = self.lowest_counts.min(counts);
        self.highest_counts = self.highest_counts.max(counts);
    }

    /// The mean of the counts, once there are enough measurements.
    ///
    /// # Errors
    /// [`Moving`] as soon as they vary too much.
    pub(super) fn estimate(&self) -> Result<Option<f32>, Moving> {
        let &Self { largest_spread_counts, measurements, .. } = self;
        let spread_counts = if measurements == 0 { 0 } else { self.highest_counts.abs_diff(self.lowest_counts) };
        if spread_counts > largest_spread_counts {
            return Err(Moving { spread_counts, largest_spread_counts });
        }
        // The mean of 17-bit counts keeps at least 7 bits of its fraction.
        #[allow(clippy::cast_possible_truncation, reason = "a mean of i32 is within the range of f32")]
        let mean_counts = (self.sum_counts as f64 / f64::from(measurements)) as f32;
        Ok((measurements >= self.needed).then_some(mean_counts))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn a_zero_needs_all_its_measurements() {
        let mut zero = Zero::new(2, 0);
        assert_eq!(zero.estimate(), Ok(None));
        zero.add(7);
        assert_eq!(zero.estimate(), Ok(None));
        zero.add(7);
        assert_eq!(zero.estimate(), Ok(Some(7.0)));
    }

    #[test]
    fn no_measurements_are_never_a_zero() {
        assert_eq!(Zero::new(0, 5).estimate(), Ok(None));
    }

    proptest! {
        #[test]
        fn a_moving_whisker_is_refused_and_a_still_one_has_its_mean(
            counts in prop::collection::vec(-32768_i32..32768, 1..40), limit in 0_u32..70_000,
        ) {
            let mut zero = Zero::new(1, limit);
            for count in &counts {
                zero.add(*count);
            }
            let spread_counts = counts.iter().max().zip(counts.iter().min()).map_or(0, |(a, b)| a.abs_diff(*b));
            match zero.estimate() {
                Ok(found) => {
                    let mean = counts.iter().map(|count| f64::from(*count)).sum::<f64>() / counts.len() as f64;
                    prop_assert!(found.is_some_and(|found| (f64::from(found) - mean).abs() < 0.01));
                    prop_assert!(spread_counts <= limit);
                }
                Err(error) => {
                    prop_assert!(spread_counts > limit);
                    prop_assert_eq!(error, Moving { spread_counts, largest_spread_counts: limit });
                }
            }
        }
    }
}
