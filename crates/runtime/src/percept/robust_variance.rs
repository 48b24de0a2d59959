//! The variance of normally distributed values with outliers.

use crate::math;

/// The variance of values with the mean 0, from their magnitudes. The median of a window is not affected by single
/// outliers. Windows are averaged.
#[derive(Debug, Clone)]
pub(super) struct RobustVariance {
    /// Variance that is expected before the first window, for the limit of one window.
    expected: f64,
    /// Magnitudes in the current window, and their number.
    magnitudes: [f64; WINDOW],
    filled: usize,
    /// Average variance of the windows, and the number of windows that it counts as.
    variance: f64,
    windows: f64,
}

/// Number of values in a window.
const WINDOW: usize = 31;
/// Median magnitude of a normal distribution with the standard deviation 1.
const NORMAL_MEDIAN: f64 = 0.674_489_750_196_081_7;
/// Relative standard deviation of the result of one window. It includes the correlation of successive values.
const WINDOW_DEVIATION: f64 = 0.25;
/// Number of windows after which older ones are forgotten.
const REMEMBERED: f64 = 50.0;
/// Largest variance of a window over the known one. A window with more is no noise but a vibration.
const MOST_GROWTH: f64 = 4.0;
/// Number of standard deviations by which the result must exceed a limit.
const SIGNIFICANT: f64 = 3.0;

impl RobustVariance {
    /// Creates an empty measurement. `expected` is the expected standard deviation.
    pub(super) fn new(expected: f64) -> Self {
        let expected = math::square(expected);
        Self { expected, magnitudes: [0.0; WINDOW], filled: 0, variance: 0.0, windows: 0.0 }
    }

    /// Adds a value.
    pub(super) fn take(&mut self, value: f64) {
        self.magnitudes[self.filled] = value.abs();
        self.filled += 1;
        if self.filled == WINDOW {
            self.filled = 0;
            self.magnitudes.sort_unstable_by(f64::total_cmp);
            let variance = math::square(self.magnitudes[WINDOW / 2] / NORMAL_MEDIAN);
            let known = math::max(self.variance, self.expected);
            let variance = if self.windows > 0.0 { math::min(variance, MOST_GROWTH * known) } else { variance };
            self.windows = math::min(self.windows + 1.0, REMEMBERED);
            self.variance += (variance - self.variance) / self.windows;
        }
    }

    /// The standard deviation, if it is significantly larger than `limit`.
    pub(super) fn beyond(&self, limit: f64) -> Option<f64> {
        let deviation = self.variance.sqrt();
        let own = WINDOW_DEVIATION / math::max(self.windows, 1.0).sqrt();
        (deviation * (1.0 - SIGNIFICANT * own) > limit).then_some(deviation)
    }
}

#[cfg(test)]
pub(super) mod tests {
    use proptest::prelude::*;

    use super::*;

    /// So many independent values of a normal distribution, as sums of uniform ones.
    pub(in super::super) fn normals(count: usize) -> impl Strategy<Value = Vec<f64>> {
        let uniform = prop::collection::vec(0.0..1.0_f64, 12);
        prop::collection::vec(uniform.prop_map(|values| values.iter().sum::<f64>() - 6.0), count).no_shrink()
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(40))]

        #[test]
        fn a_tenth_of_outliers_hardly_matters(values in normals(600), exponent in -6.0..2.0_f64) {
            let deviation = math::powf(10.0, exponent);
            let mut variance = RobustVariance::new(deviation);
            for (index, value) in values.iter().enumerate() {
                variance.take(if index % 10 == 0 { 1e3 * deviation } else { deviation * value });
            }
            let found = variance.beyond(0.0).unwrap_or(0.0);
            prop_assert!((0.85..1.4).contains(&(found / deviation)), "{found} {deviation}");
            prop_assert_eq!(variance.beyond(1.2 * found), None);
        }
    }
}
