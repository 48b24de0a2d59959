//! The delay of commands, from whiskers in free air.

use crate::math;

/// The delay of the platform behind commands, from the inertia of whiskers in free air.
///
/// A platform that accelerates bends its whiskers. Readings are not late, so they show when a command takes effect. Poses
/// show it as well, but they may be late. Every delay of a grid explains a part of the readings.
#[derive(Debug, Clone)]
pub(super) struct CommandDelay {
    /// Sums of the squared readings that a delay leaves, in standard deviations, and that of the readings themselves.
    costs: [f64; DELAYS],
    without: f64,
}

/// Number of delays, and the time between two of them (s).
const DELAYS: usize = 14;
const SPACING: f64 = 0.01;
/// Standard deviation (rad) of a mean reading in free air, because a whisker swings.
const SWING: f64 = 5e-7;
/// Largest squared reading.
const LARGEST: f64 = 25.0;
/// Share of a sum that is left after the next reading. Readings of some minutes count.
const REMEMBERED: f64 = 0.9998;
/// Smallest sum of the readings, and the largest share of it that the best delay may leave. Whiskers that swing have more
/// readings that no delay explains.
const LEAST: f64 = 50.0;
const MOST_LEFT: f64 = 0.9;

impl CommandDelay {
    /// Creates the measurement.
    pub(super) fn new() -> Self {
        Self { costs: [0.0; DELAYS], without: 0.0 }
    }

    /// Adds a mean reading (rad) without its offset, and its standard deviation (rad). `bent` is the base angle (rad) that
    /// inertia causes with a delay (s) of commands.
    pub(super) fn add(&mut self, reading: f64, deviation: f64, bent: impl Fn(f64) -> f64) {
        let variance = math::square(deviation) + math::square(SWING);
        let left = |bent: f64| math::min(math::square(reading - bent) / variance, LARGEST);
        for (index, cost) in self.costs.iter_mut().enumerate() {
            *cost = *cost * REMEMBERED + left(bent(index as f64 * SPACING));
        }
        self.without = self.without * REMEMBERED + left(0.0);
    }

    /// What a delay (s) leaves of the readings, in squared standard deviations. 0 without significant inertia.
    pub(super) fn cost(&self, delay: f64) -> f64 {
        let best = self.costs.iter().copied().fold(f64::INFINITY, math::min);
        if self.without < LEAST || best > MOST_LEFT * self.without {
            return 0.0;
        }
        let along = (delay / SPACING).clamp(0.0, (DELAYS - 1) as f64);
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "within the grid")]
        let below = (along as usize).min(DELAYS - 2);
        self.costs[below] + (self.costs[below + 1] - self.costs[below]) * (along - below as f64)
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::super::robust_variance::tests::normals;
    use super::*;

    /// The cost of every delay from 0 to 0.13 s, for readings of a whisker with this effect of inertia.
    fn costs(values: &[f64], delay: f64, effect: f64) -> Vec<f64> {
        let mut commands = CommandDelay::new();
        for (tick, value) in values.iter().enumerate() {
            let time = tick as f64 / 30.0;
            let bent = |delay: f64| 2e-6 * math::sin(4.0 * (time - delay));
            commands.add(effect * bent(delay) + 2e-7 * value, 2e-7, bent);
        }
        (0..=130).map(|time| commands.cost(f64::from(time) * 1e-3)).collect()
    }

    proptest! {
        #[test]
        fn the_delay_of_inertia_costs_least(values in normals(300), delay in 0.0..0.13_f64) {
            let costs = costs(&values, delay, 1.0);
            let best = (0..costs.len()).min_by(|a, b| costs[*a].total_cmp(&costs[*b])).unwrap_or(0);
            prop_assert!((best as f64 * 1e-3 - delay).abs() < 0.016, "{best} ms, {delay} s");
        }

        #[test]
        fn without_inertia_every_delay_costs_the_same(values in normals(300), delay in 0.0..0.13_f64) {
            prop_assert!(costs(&values, delay, 0.0).iter().all(|cost| *cost == 0.0));
        }
    }
}
