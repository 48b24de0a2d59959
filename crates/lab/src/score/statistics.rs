//! Statistics of a set of numbers.

use statrs::distribution::{ContinuousCDF, StudentsT};
use vibrissa_runtime::math;

/// Confidence level of an interval of a mean.
const CONFIDENCE: f64 = 0.95;

/// A sorted, non-empty set of numbers.
///
/// ```
/// use vibrissa_lab::score::Statistics;
/// let statistics = Statistics::of(vec![4.0, 1.0, 3.0, 2.0]).unwrap();
/// assert_eq!(statistics.mean(), 2.5);
/// assert_eq!(statistics.percentile(50.0), 2.5);
/// assert_eq!(statistics.max(), 4.0);
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Statistics {
    /// In ascending order, so that sums do not depend on the original order.
    sorted: Vec<f64>,
}

impl Statistics {
    /// The statistics of `values`. `None` if there are none.
    #[must_use]
    pub fn of(mut values: Vec<f64>) -> Option<Self> {
        values.sort_by(f64::total_cmp);
        (!values.is_empty()).then_some(Self { sorted: values })
    }

    /// The number of values.
    #[must_use]
    pub fn count(&self) -> usize {
        self.sorted.len()
    }

    /// The mean.
    #[must_use]
    pub fn mean(&self) -> f64 {
        self.sorted.iter().sum::<f64>() / self.count() as f64
    }

    /// The sample standard deviation with the divisor `n − 1`. `None` for a single value.
    #[must_use]
    pub fn std(&self) -> Option<f64> {
        let mean = self.mean();
        let squares: f64 = self.sorted.iter().map(|value| math::square(value - mean)).sum();
        (self.count() > 1).then(|| (squares / (self.count() - 1) as f64).sqrt())
    }

    /// The 95 % confidence interval of the mean of the population by Student's t. `None` for a single value.
    ///
    /// Samples are often small. With ten values a percentile bootstrap covers the mean in only some 90 % of cases, with five in
    /// some 80 %. Student's t stays close to 95 % even for values that are far from normal.
    #[must_use]
    pub fn mean_interval(&self) -> Option<[f64; 2]> {
        let std = self.std()?;
        let count = self.count() as f64;
        let quantile = StudentsT::new(0.0, 1.0, count - 1.0).ok()?.inverse_cdf(0.5 + 0.5 * CONFIDENCE);
        let half = quantile * std / count.sqrt();
        Some([self.mean() - half, self.mean() + half])
    }

    /// The percentile for `percent` (0 to 100), by linear interpolation. The `k`-th of `n` sorted numbers, counted from
    /// 0, is the percentile `100 k / (n − 1)` (definition 7 of Hyndman and Fan).
    #[must_use]
    pub fn percentile(&self, percent: f64) -> f64 {
        let last = self.count() - 1;
        let place = (percent / 100.0).clamp(0.0, 1.0) * last as f64;
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "between 0 and the last index")]
        let below = place as usize;
        let (low, high) = (self.sorted[below], self.sorted[last.min(below + 1)]);
        let share = place - below as f64;
        // An exact position takes its value directly, because the difference of infinities is not a number.
        if share > 0.0 { low + share * (high - low) } else { low }
    }

    /// The maximum.
    #[must_use]
    pub fn max(&self) -> f64 {
        self.sorted[self.count() - 1]
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]

    use proptest::prelude::*;

    use super::*;

    #[test]
    fn nothing_has_no_statistics_and_one_number_no_deviation() {
        assert_eq!(Statistics::of(vec![]), None);
        let one = Statistics::of(vec![3.0]).unwrap();
        assert_eq!((one.mean(), one.std(), one.percentile(95.0), one.max()), (3.0, None, 3.0, 3.0));
    }

    #[test]
    fn the_deviation_is_the_sample_s() {
        let statistics = Statistics::of(vec![2.0, 4.0, 4.0, 4.0, 5.0, 5.0, 7.0, 9.0]).unwrap();
        assert!((statistics.std().unwrap() - (32.0_f64 / 7.0).sqrt()).abs() < 1e-15);
    }

    proptest! {
        #[test]
        fn statistics_agree_with_their_definitions(values in prop::collection::vec(-1e3..1e3_f64, 2..60)) {
            let statistics = Statistics::of(values.clone()).unwrap();
            let count = values.len() as f64;
            prop_assert!((statistics.mean() * count - values.iter().sum::<f64>()).abs() < 1e-9);
            // The variance as half of the mean squared difference of all pairs does not use the mean.
            let pairs = values.iter().flat_map(|a| values.iter().map(move |b| math::square(a - b))).sum::<f64>();
            let variance = 0.5 * pairs / (count * (count - 1.0));
            prop_assert!((math::square(statistics.std().unwrap()) - variance).abs() < 1e-8 * variance.max(1.0));
            for (percent, least) in [(0.0, 0.0), (25.0, 0.25), (95.0, 0.95), (100.0, 1.0)] {
                let bound = statistics.percentile(percent);
                let below = values.iter().filter(|&&value| value <= bound + 1e-9).count() as f64;
                let above = values.iter().filter(|&&value| value >= bound - 1e-9).count() as f64;
                prop_assert!(below >= (least * (count - 1.0)).floor() + 1.0);
                prop_assert!(above >= ((1.0 - least) * (count - 1.0)).floor() + 1.0);
            }
        }

        #[test]
        fn the_order_of_the_numbers_changes_nothing(
            (values, shuffled) in prop::collection::vec(-1e3..1e3_f64, 1..60)
                .prop_flat_map(|values| (Just(values.clone()), Just(values).prop_shuffle())),
        ) {
            let (a, b) = (Statistics::of(values).unwrap(), Statistics::of(shuffled).unwrap());
            prop_assert_eq!(a.mean().to_bits(), b.mean().to_bits());
            prop_assert_eq!(a.std(), b.std());
        }
    }
}
