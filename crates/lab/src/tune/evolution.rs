//! Covariance matrix adaptation: a search for a minimum without derivatives.

use nalgebra::{DMatrix, DVector};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use vibrissa_runtime::math;

/// The first standard deviation of a coordinate, as a share of its range.
const FIRST_STEP: f64 = 0.2;
/// The smallest standard deviation of a direction relative to the step. It keeps the inverse finite.
const LEAST_DEVIATION: f64 = 1e-8;

/// A search by an evolution strategy that adapts the covariance matrix of its samples.
///
/// The search space is the unit box. Samples outside are reflected at its sides. The caller evaluates each generation
/// and returns the costs. Only their order counts. The formulas and constants are those of N. Hansen, "The CMA Evolution
/// Strategy: A Tutorial" (arXiv 1604.00772), without negative weights. Equal costs and an equal seed give an equal search.
///
/// ```
/// use vibrissa_lab::tune::Evolution;
/// let mut evolution = Evolution::new(&[0.9, 0.1], 1);
/// for _ in 0..60 {
///     let costs: Vec<f64> = evolution.ask().iter().map(|x| (x[0] - 0.3).powi(2) + (x[1] - 0.6).powi(2)).collect();
///     evolution.tell(&costs);
/// }
/// assert!((evolution.mean()[0] - 0.3).abs() < 1e-4);
/// ```
#[derive(Debug, Clone)]
pub struct Evolution {
    constants: Constants,
    random: ChaCha8Rng,
    generation: i32,
    mean: DVector<f64>,
    step: f64,
    covariance: DMatrix<f64>,
    step_path: DVector<f64>,
    covariance_path: DVector<f64>,
    /// Axes of the covariance with their standard deviations.
    axes: DMatrix<f64>,
    deviations: DVector<f64>,
    /// Displacements of the last samples from the mean, in steps.
    displacements: Vec<DVector<f64>>,
}

/// Constants that depend on the number of coordinates.
#[derive(Debug, Clone)]
struct Constants {
    samples: usize,
    weights: Vec<f64>,
    effective: f64,
    step_path_rate: f64,
    damping: f64,
    covariance_path_rate: f64,
    rank_one: f64,
    rank_many: f64,
    /// The expected length of a vector of normal numbers.
    expected_length: f64,
}

impl Constants {
    fn new(coordinates: usize) -> Self {
        let n = coordinates as f64;
        let samples = Evolution::samples_of(coordinates);
        let raw =
            (0..samples / 2).map(|rank| math::ln(f64::midpoint(samples as f64, 1.0)) - math::ln(rank as f64 + 1.0));
        let raw: Vec<f64> = raw.collect();
        let sum: f64 = raw.iter().sum();
        let weights: Vec<f64> = raw.iter().map(|weight| weight / sum).collect();
        let effective = 1.0 / weights.iter().map(|weight| weight * weight).sum::<f64>();
        let step_path_rate = (effective + 2.0) / (n + effective + 5.0);
        let rank_one = 2.0 / (math::square(n + 1.3) + effective);
        Self {
            samples,
            weights,
            effective,
            step_path_rate,
            damping: 1.0 + 2.0 * (((effective - 1.0) / (n + 1.0)).sqrt() - 1.0).max(0.0) + step_path_rate,
            covariance_path_rate: (4.0 + effective / n) / (n + 4.0 + 2.0 * effective / n),
            rank_one,
            rank_many: (1.0 - rank_one)
                .min(2.0 * (effective - 2.0 + 1.0 / effective) / (math::square(n + 2.0) + effective)),
            expected_length: n.sqrt() * (1.0 - 1.0 / (4.0 * n) + 1.0 / (21.0 * n * n)),
        }
    }
}

impl Evolution {
    /// A search from a point in the unit box, with at least one coordinate.
    #[must_use]
    pub fn new(start: &[f64], seed: u64) -> Self {
        let n = start.len();
        Self {
            constants: Constants::new(n),
            random: ChaCha8Rng::seed_from_u64(seed),
            generation: 0,
            mean: DVector::from_column_slice(start),
            step: FIRST_STEP,
            covariance: DMatrix::identity(n, n),
            step_path: DVector::zeros(n),
            covariance_path: DVector::zeros(n),
            axes: DMatrix::identity(n, n),
            deviations: DVector::repeat(n, 1.0),
            displacements: Vec::new(),
        }
    }

    /// Number of samples of a generation for a number of coordinates.
    #[must_use]
    pub fn samples_of(coordinates: usize) -> usize {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a small positive number")]
        let more = (3.0 * math::ln(coordinates.max(1) as f64)) as usize;
        4 + more
    }

    /// The centre of the search, in the unit box.
    #[must_use]
    pub fn mean(&self) -> Vec<f64> {
        self.mean.iter().copied().map(reflected).collect()
    }

    /// Samples a generation of points in the unit box.
    pub fn ask(&mut self) -> Vec<Vec<f64>> {
        let n = self.mean.len();
        self.displacements = (0..self.constants.samples)
            .map(|_| {
                let normal = DVector::from_fn(n, |_, _| StandardNormal.sample(&mut self.random));
                &self.axes * self.deviations.component_mul(&normal)
            })
            .collect();
        let point = |displacement: &DVector<f64>| {
            let point = &self.mean + self.step * displacement;
            point.iter().copied().map(reflected).collect()
        };
        self.displacements.iter().map(point).collect()
    }

    /// Moves the search by the costs of the last generation, in its order.
    pub fn tell(&mut self, costs: &[f64]) {
        let Constants { effective, step_path_rate, damping, covariance_path_rate, rank_one, rank_many, .. } =
            self.constants;
        let mut ranked: Vec<(&DVector<f64>, f64)> = self.displacements.iter().zip(costs.iter().copied()).collect();
        ranked.sort_by(|a, b| a.1.total_cmp(&b.1));
        let best = || self.constants.weights.iter().zip(ranked.iter().map(|&(displacement, _)| displacement));
        let n = self.mean.len();
        let shift = best().fold(DVector::zeros(n), |sum, (&weight, displacement)| sum + weight * displacement);
        let spread = best().fold(DMatrix::zeros(n, n), |sum, (&weight, displacement)| {
            sum + weight * displacement * displacement.transpose()
        });
        self.generation += 1;
        self.mean += self.step * &shift;
        let whitened = &self.axes * (self.axes.transpose() * &shift).component_div(&self.deviations);
        let kept = 1.0 - step_path_rate;
        self.step_path = kept * &self.step_path + (step_path_rate * (1.0 + kept) * effective).sqrt() * whitened;
        let length = self.step_path.norm();
        let warm = (1.0 - math::powi(kept, 2 * self.generation)).sqrt();
        // A long path means that the step is too small. Until it has grown, the covariance does not follow the path.
        let follows = length / warm < (1.4 + 2.0 / (n as f64 + 1.0)) * self.constants.expected_length;
        let kept = 1.0 - covariance_path_rate;
        self.covariance_path *= kept;
        if follows {
            self.covariance_path += (covariance_path_rate * (1.0 + kept) * effective).sqrt() * &shift;
        }
        let path = &self.covariance_path * self.covariance_path.transpose();
        let lost = if follows { 0.0 } else { covariance_path_rate * (1.0 + kept) };
        let rest = 1.0 - rank_one - rank_many + rank_one * lost;
        self.covariance = rest * &self.covariance + rank_one * path + rank_many * spread;
        self.step *= math::exp(step_path_rate / damping * (length / self.constants.expected_length - 1.0));
        let eigen = self.covariance.clone().symmetric_eigen();
        self.axes = eigen.eigenvectors;
        self.deviations = eigen.eigenvalues.map(|value| value.max(0.0).sqrt().max(LEAST_DEVIATION));
    }
}

/// A coordinate reflected at 0 and 1 until it is between them.
fn reflected(value: f64) -> f64 {
    let value = value.rem_euclid(2.0);
    if value > 1.0 { 2.0 - value } else { value }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// The mean after a number of generations.
    fn found(start: &[f64], seed: u64, generations: usize, cost: impl Fn(&[f64]) -> f64) -> Vec<f64> {
        let mut evolution = Evolution::new(start, seed);
        for _ in 0..generations {
            let costs: Vec<f64> = evolution.ask().iter().map(|point| cost(point)).collect();
            evolution.tell(&costs);
        }
        evolution.mean()
    }

    fn distance(a: &[f64], b: &[f64]) -> f64 {
        a.iter().zip(b).map(|(a, b)| math::square(a - b)).sum::<f64>().sqrt()
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(24))]

        #[test]
        fn the_minimum_of_a_stretched_bowl_is_found_from_everywhere(
            start in prop::collection::vec(0.0..1.0, 4), goal in prop::collection::vec(0.1..0.9, 4), seed: u64,
        ) {
            // Curvatures from 1 to 1000, along oblique directions.
            let cost = |x: &[f64]| {
                let d: Vec<f64> = x.iter().zip(&goal).map(|(x, goal)| x - goal).collect();
                math::square(d[0] + d[1]) + 10.0 * math::square(d[0] - d[1]) + 100.0 * math::square(d[2] + d[3])
                    + 1000.0 * math::square(d[2] - d[3])
            };
            prop_assert!(distance(&found(&start, seed, 200, cost), &goal) < 1e-4);
        }

        #[test]
        fn samples_stay_in_the_box_and_only_the_order_of_costs_counts(start in prop::collection::vec(0.0..=1.0, 3), seed: u64) {
            // The minimum is outside of the box.
            let cost = |x: &[f64]| distance(x, &[2.0, -1.0, 0.5]);
            let mut evolution = Evolution::new(&start, seed);
            let mut other = evolution.clone();
            for _ in 0..40 {
                let points = evolution.ask();
                prop_assert_eq!(&points, &other.ask());
                prop_assert!(points.iter().flatten().all(|x| (0.0..=1.0).contains(x)));
                let costs: Vec<f64> = points.iter().map(|point| cost(point)).collect();
                evolution.tell(&costs);
                other.tell(&costs.iter().map(|cost| math::exp(*cost) - 7.0).collect::<Vec<_>>());
            }
        }
    }

    #[test]
    fn a_curved_valley_is_followed_to_its_end() {
        // Rosenbrock's function, whose minimum is at (1, 1), in a box from -2 to 2.
        let cost = |x: &[f64]| {
            let (x, y) = (4.0 * x[0] - 2.0, 4.0 * x[1] - 2.0);
            math::square(1.0 - x) + 100.0 * math::square(y - x * x)
        };
        for seed in 0..5 {
            assert!(distance(&found(&[0.2, 0.8], seed, 200, cost), &[0.75, 0.75]) < 1e-3);
        }
    }
}
