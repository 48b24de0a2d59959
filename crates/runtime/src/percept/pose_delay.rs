//! The delay of measured poses, from contacts.

use crate::math;

use super::platform_motion::vertex;

/// The misfit of a reading with the contact that was expected before it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Misfit {
    /// Distance (m) of the contact by the reading from the expected surface, along its normal.
    pub distance: f64,
    /// Change of this distance (m/s) by the delay of poses behind readings.
    pub by_delay: f64,
    /// Variance of the distance (m²).
    pub variance: f64,
}

/// The delay of poses behind readings.
///
/// With late poses, a contact seems to move along with the platform whenever its velocity changes. Every delay of a grid
/// explains a part of each misfit. Misfits have limited weight, because a tip that slips explains them as well.
#[derive(Debug, Clone)]
pub(super) struct PoseDelay {
    /// Sums of the squared misfits that a delay leaves, in standard deviations.
    costs: [f64; DELAYS],
}

/// Number of delays, and the time between two of them (s).
const DELAYS: usize = 16;
const SPACING: f64 = 0.01;
/// Standard deviation (m) of a misfit for other reasons.
const OTHER: f64 = 3e-5;
/// Largest squared misfit.
const LARGEST: f64 = 16.0;
/// Share of a misfit that is left after the next one. Misfits of half a minute count.
const REMEMBERED: f64 = 0.9999;
/// Smallest difference of the sums between no delay and the best one.
const SIGNIFICANT: f64 = 25.0;

impl PoseDelay {
    /// Creates the measurement.
    pub(super) fn new() -> Self {
        Self { costs: [0.0; DELAYS] }
    }

    /// Adds a misfit of a reading whose pose has been corrected by `corrected` (s).
    pub(super) fn add(&mut self, misfit: &Misfit, corrected: f64) {
        let variance = misfit.variance + math::square(OTHER) + math::square(0.5 * SPACING * misfit.by_delay);
        for (index, cost) in self.costs.iter_mut().enumerate() {
            let delay = index as f64 * SPACING - corrected;
            let left = math::square(misfit.distance - misfit.by_delay * delay) / variance;
            *cost = *cost * REMEMBERED + math::min(left, LARGEST);
        }
    }

    /// The delay (s), at most `most`. 0 unless it is significant. `other` is what a delay (s) leaves of other measurements,
    /// in squared standard deviations.
    pub(super) fn value(&self, most: f64, other: impl Fn(f64) -> f64) -> f64 {
        let costs: [f64; DELAYS] = std::array::from_fn(|index| self.costs[index] + other(index as f64 * SPACING));
        let possible = costs.iter().enumerate().filter(|(index, _)| *index as f64 * SPACING <= most + 0.5 * SPACING);
        match possible.min_by(|(_, a), (_, b)| a.total_cmp(b)) {
            Some((index, cost)) if costs[0] - cost > SIGNIFICANT => {
                let between = vertex(index, DELAYS, |index| costs[index]);
                math::min((index as f64 + between) * SPACING, most)
            }
            _ => 0.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::super::robust_variance::tests::normals;
    use super::*;

    proptest! {
        #[test]
        fn a_delay_is_found_among_slips_and_never_exceeds_the_total(
            values in normals(400), delay in 0.0..0.1_f64, corrected in 0.0..0.1_f64, most in 0.0..0.15_f64,
        ) {
            let mut poses = PoseDelay::new();
            for pair in values.chunks(2) {
                let by_delay = 0.03 * pair[0];
                let slip = if pair[1] > 1.5 { 2e-3 } else { 0.0 };
                let distance = by_delay * (delay - corrected) + 1e-5 * pair[1] + slip;
                poses.add(&Misfit { distance, by_delay, variance: 1e-10 }, corrected);
            }
            prop_assert!(poses.value(most, |_| 0.0) <= most);
            prop_assert!((poses.value(1.0, |_| 0.0) - delay).abs() < 0.006, "{} s", poses.value(1.0, |_| 0.0));
        }
    }
}
