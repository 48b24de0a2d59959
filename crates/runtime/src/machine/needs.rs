//! The needs that a policy states: rates of the loop and age of samples.

use std::fmt;

use serde::{Deserialize, Serialize};

use crate::math;
use crate::units::{Dimension, format_si};

/// The needs that a policy states. They concern the loop that runs it.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Needs {
    /// Allowed control rates. `None` for the one of the rig.
    pub control_rate: Option<RateRange>,
    /// Allowed sample rates. `None` for the one of the rig.
    pub sample_rate: Option<RateRange>,
    /// Largest age of a sample (s). `None` for any.
    pub sample_age: Option<f64>,
}

/// A range of rates.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct RateRange {
    /// Lowest rate (Hz).
    pub low: f64,
    /// Highest rate (Hz).
    pub high: f64,
}

/// Relative tolerance of comparisons of rates. Rates come from texts with few digits.
const TOLERANCE: f64 = 1e-9;

impl RateRange {
    /// The range of one rate (Hz).
    #[must_use]
    pub fn only(rate: f64) -> Self {
        Self { low: rate, high: rate }
    }

    /// True if `rate` (Hz) is in the range, up to rounding.
    #[must_use]
    pub fn contains(&self, rate: f64) -> bool {
        self.low * (1.0 - TOLERANCE) <= rate && rate <= self.high * (1.0 + TOLERANCE)
    }

    /// True if a rate of this range can be a whole multiple of a rate of `slower`.
    #[must_use]
    pub fn has_multiple_of(&self, slower: &Self) -> bool {
        let least = math::max((self.low / slower.high * (1.0 - TOLERANCE)).ceil(), 1.0);
        least * slower.low <= self.high * (1.0 + TOLERANCE)
    }

    fn is_valid(&self) -> bool {
        self.low > 0.0 && self.low <= self.high && self.high.is_finite()
    }
}

impl fmt::Display for RateRange {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let rate = |rate| format_si(rate, Dimension::FREQUENCY);
        if self.low < self.high {
            write!(formatter, "{} to {}", rate(self.low), rate(self.high))
        } else {
            formatter.write_str(&rate(self.low))
        }
    }
}

/// A rate of a rig that the policy does not allow.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error("the policy needs a {name} rate of {allowed}, but the rig has {}", format_si(*rate, Dimension::FREQUENCY))]
pub struct UnmetRate {
    /// The rate: `control` or `sample`.
    pub name: &'static str,
    /// The allowed rates.
    pub allowed: RateRange,
    /// The rate of the rig (Hz).
    pub rate: f64,
}

impl Needs {
    /// Checks the rates (Hz) of a rig.
    ///
    /// # Errors
    /// [`UnmetRate`] with the first rate that is out of its range.
    pub fn check_rates(&self, control_rate: f64, sample_rate: f64) -> Result<(), UnmetRate> {
        for (name, allowed, rate) in
            [("control", self.control_rate, control_rate), ("sample", self.sample_rate, sample_rate)]
        {
            if let Some(allowed) = allowed.filter(|allowed| !allowed.contains(rate)) {
                return Err(UnmetRate { name, allowed, rate });
            }
        }
        Ok(())
    }

    /// True if the ranges are ordered, positive and finite, and if the rates can have a whole ratio.
    #[must_use]
    pub fn are_valid(&self) -> bool {
        let is_age = self.sample_age.is_none_or(|age| age > 0.0 && age.is_finite());
        let ranges = [self.control_rate, self.sample_rate];
        let has_ratio = match ranges {
            [Some(control), Some(sample)] => sample.has_multiple_of(&control),
            _ => true,
        };
        is_age && has_ratio && ranges.iter().flatten().all(RateRange::is_valid)
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn range() -> impl Strategy<Value = RateRange> {
        (1_u32..400, 0_u32..100).prop_map(|(low, width)| RateRange { low: low.into(), high: (low + width).into() })
    }

    proptest! {
        #[test]
        fn two_ranges_have_a_whole_ratio_exactly_if_a_multiple_of_one_overlaps_the_other(slow in range(), fast in range()) {
            let overlaps = |ratio: u32| {
                let ratio = f64::from(ratio);
                ratio * slow.low <= fast.high && fast.low <= ratio * slow.high
            };
            prop_assert_eq!(fast.has_multiple_of(&slow), (1..=500).any(overlaps));
        }

        #[test]
        fn the_ends_of_a_range_are_in_it(range in range()) {
            prop_assert!(range.contains(range.low) && range.contains(range.high));
            prop_assert!(!range.contains(range.low - 0.5) && !range.contains(range.high + 0.5));
        }
    }
}
