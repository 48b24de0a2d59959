//! What sensors make of the truth.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use rand_distr::{Distribution, Normal};

use vibrissa_runtime::rig::Sensing;

/// No sensor reads an angle (rad) below this. The motion of a free whisker fades beyond the normal numbers, with which processors take a
/// hundred times as long, and so would all that is made of readings.
const FADED: f64 = 1e-290;

/// The sensors at the bases of whiskers: noise and resolution, the same in every world.
#[derive(Debug, Clone)]
pub(crate) struct Sensors {
    noise: Option<Normal<f64>>,
    resolution: f64,
    force_noise: Option<Normal<f64>>,
    random: ChaCha8Rng,
}

impl Sensors {
    /// Sensors of which the `seed` fixes the noise.
    pub(crate) fn new(sensing: &Sensing, seed: u64) -> Self {
        Self {
            noise: normal(sensing.angle_noise),
            resolution: sensing.angle_resolution,
            force_noise: normal(sensing.force_noise),
            random: ChaCha8Rng::seed_from_u64(seed),
        }
    }

    /// What is read of a base angle (rad).
    pub(crate) fn read(&mut self, base_angle: f64) -> f64 {
        let noisy = base_angle + drawn(self.noise, &mut self.random);
        if self.resolution > 0.0 {
            (noisy / self.resolution).round() * self.resolution
        } else if noisy.abs() < FADED {
            0.0
        } else {
            noisy
        }
    }

    /// What is read of a force (N) at the base.
    pub(crate) fn read_force(&mut self, force: f64) -> f64 {
        force + drawn(self.force_noise, &mut self.random)
    }
}

/// Noise of a standard deviation, if there is any.
fn normal(spread: f64) -> Option<Normal<f64>> {
    Normal::new(0.0, spread).ok().filter(|_| spread > 0.0)
}

fn drawn(noise: Option<Normal<f64>>, random: &mut ChaCha8Rng) -> f64 {
    noise.map_or(0.0, |noise| noise.sample(random))
}

/// Rounds to a count; scenes are validated so that the value is one.
pub(crate) fn whole(value: f64) -> usize {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a validated small count")]
    let count = value.round().max(1.0) as usize;
    count
}
