//! The neutral value of an axis.

use thiserror::Error;

/// A running estimate of the counts of a whisker at rest.
///
/// The sensor's offset drifts by up to ±1000 counts with temperature, so the zero must be measured in each session.
///
/// ```
/// use vibrissa_mlx90393::Zero;
/// let mut zero = Zero::new(4, 10);
/// for counts in [100, 103, 99, 102] {
///     zero.add(counts);
/// }
/// assert_eq!(zero.estimate().map(|neutral| neutral.mean_counts), Ok(101.0));
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Zero {
    needed: u32,
    largest_spread_counts: u32,
    measurements: u32,
    sum_counts: i64,
    lowest_counts: i32,
    highest_counts: i32,
}

/// The counts of a whisker at rest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Neutral {
    /// Mean.
    pub mean_counts: f32,
    /// Difference between the highest and the lowest counts.
    pub spread_counts: u32,
}

/// The reason why there is no neutral value.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum NotNeutral {
    /// There are too few measurements.
    #[error("the zero needs {missing} more measurements")]
    TooFew {
        /// Number of missing measurements.
        missing: u32,
    },
    /// The counts vary more than noise does.
    #[error(
        "the counts vary by {spread_counts}, more than {largest_spread_counts}. Keep the whisker still and free, and measure the zero again"
    )]
    Moving {
        /// Difference between the highest and the lowest counts.
        spread_counts: u32,
        /// The largest permitted difference.
        largest_spread_counts: u32,
    },
}

impl Zero {
    /// Creates an estimate that needs this many measurements, at least one, and permits this difference between the
    /// highest and the lowest.
    #[must_use]
    pub const fn new(measurements: u32, largest_spread_counts: u32) -> Self {
        Self {
            needed: if measurements == 0 { 1 } else { measurements },
            largest_spread_counts,
            measurements: 0,
            sum_counts: 0,
            lowest_counts: i32::MAX,
            highest_counts: i32::MIN,
        }
    }

    /// Adds a measurement. Measurements beyond the needed number are included too.
    pub fn add(&mut self, counts: i32) {
        self.measurements = self.measurements.saturating_add(1);
        self.sum_counts = self.sum_counts.saturating_add(i64::from(counts));
        self.lowest_counts = self.lowest_counts.min(counts);
        self.highest_counts = self.highest_counts.max(counts);
    }

    /// Forgets all measurements.
    pub fn clear(&mut self) {
        *self = Self::new(self.needed, self.largest_spread_counts);
    }

    /// The neutral value.
    ///
    /// # Errors
    /// [`NotNeutral`] if there are too few measurements, or if they vary too much.
    pub fn estimate(&self) -> Result<Neutral, NotNeutral> {
        // A whisker that moves is reported as soon as it is seen.
        let spread_counts = if self.measurements == 0 { 0 } else { self.highest_counts.abs_diff(self.lowest_counts) };
        if spread_counts > self.largest_spread_counts {
            return Err(NotNeutral::Moving { spread_counts, largest_spread_counts: self.largest_spread_counts });
        }
        if self.measurements < self.needed {
            return Err(NotNeutral::TooFew { missing: self.needed - self.measurements });
        }
        // The mean of 17-bit counts keeps at least 7 bits of its fraction.
        #[allow(clippy::cast_possible_truncation, reason = "a mean of i32 is within the range of f32")]
        let mean_counts = (self.sum_counts as f64 / f64::from(self.measurements)) as f32;
        Ok(Neutral { mean_counts, spread_counts })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn a_zero_needs_all_its_measurements() {
        let mut zero = Zero::new(2, 0);
        assert_eq!(zero.estimate(), Err(NotNeutral::TooFew { missing: 2 }));
        zero.add(7);
        assert_eq!(zero.estimate(), Err(NotNeutral::TooFew { missing: 1 }));
        zero.add(7);
        assert_eq!(zero.estimate(), Ok(Neutral { mean_counts: 7.0, spread_counts: 0 }));
        zero.clear();
        assert_eq!(zero, Zero::new(2, 0));
    }

    #[test]
    fn no_measurements_are_never_a_zero() {
        assert_eq!(Zero::new(0, 5).estimate(), Err(NotNeutral::TooFew { missing: 1 }));
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
                Ok(neutral) => {
                    let mean = counts.iter().map(|count| f64::from(*count)).sum::<f64>() / counts.len() as f64;
                    prop_assert!((f64::from(neutral.mean_counts) - mean).abs() < 0.01);
                    prop_assert!(spread_counts <= limit && neutral.spread_counts == spread_counts);
                }
                Err(error) => {
                    prop_assert!(spread_counts > limit);
                    prop_assert_eq!(error, NotNeutral::Moving { spread_counts, largest_spread_counts: limit });
                }
            }
        }
    }
}
