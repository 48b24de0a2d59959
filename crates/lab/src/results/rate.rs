//! Rates over runs, with their intervals.

use serde::Serialize;

use super::wilson::wilson;

/// The share of some runs that has a property, and the interval of the rate behind it.
///
/// ```
/// use vibrissa_lab::results::Rate;
/// let rate = Rate::new(176, 200).unwrap();
/// assert_eq!(rate.share, 0.88);
/// assert!(rate.interval[0] < 0.83 && rate.interval[1] > 0.91);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Rate {
    /// The share of the runs, 0 to 1.
    pub share: f64,
    /// The ends of the 95 % interval after Wilson, 0 to 1.
    pub interval: [f64; 2],
}

impl Rate {
    /// The rate behind `count` of `runs`. `None` without runs.
    #[must_use]
    pub fn new(count: usize, runs: usize) -> Option<Self> {
        let interval = wilson(count as u64, runs as u64)?;
        Some(Self { share: count as f64 / runs as f64, interval })
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]

    use statrs::distribution::{ContinuousCDF, Normal};

    use super::*;

    /// The quantile comes from another source than the constant of the interval.
    #[test]
    fn an_interval_has_the_rates_that_a_test_of_5_percent_does_not_exclude() {
        let quantile = Normal::new(0.0, 1.0).unwrap().inverse_cdf(0.975);
        for (count, runs) in [(0, 1), (1, 3), (176, 200), (20, 20)] {
            let Rate { share, interval } = Rate::new(count, runs).unwrap();
            assert!((interval[0]..=interval[1]).contains(&share));
            let farther = |end: f64, outwards: f64| {
                let rate = end + 1e-6 * outwards;
                (rate - share).abs() > quantile * (rate * (1.0 - rate) / runs as f64).sqrt()
            };
            for (end, outwards) in interval.into_iter().zip([-1.0, 1.0]) {
                let is_limit = end <= 0.0 || end >= 1.0;
                assert!(is_limit || farther(end, outwards) && !farther(end, -outwards), "{count} of {runs}: {end}");
            }
        }
        assert_eq!(Rate::new(0, 0), None);
    }
}
