//! What sensors make of the truth.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use rand_distr::{Distribution, Normal};

use crate::rig::Sensing;

/// The sensors at the bases of whiskers: noise and resolution, the same in every world.
#[derive(Debug, Clone)]
pub(super) struct Sensors {
    noise: Option<Normal<f64>>,
    resolution: f64,
    random: ChaCha8Rng,
}

impl Sensors {
    /// Sensors of which the `seed` fixes the noise.
    pub(super) fn new(sensing: &Sensing, seed: u64) -> Self {
        Self {
            noise: Normal::new(0.0, sensing.angle_noise).ok().filter(|_| sensing.angle_noise > 0.0),
            resolution: sensing.angle_resolution,
            random: ChaCha8Rng::seed_from_u64(seed),
        }
    }

    /// What is read of a base angle (rad).
    pub(super) fn read(&mut self, base_angle: f64) -> f64 {
        let noisy = base_angle + self.noise.map_or(0.0, |noise| noise.sample(&mut self.random));
        if self.resolution > 0.0 { (noisy / self.resolution).round() * self.resolution } else { noisy }
    }
}

/// Rounds to a count; scenes are validated so that the value is one.
pub(super) fn whole(value: f64) -> usize {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a validated small count")]
    let count = value.round().max(1.0) as usize;
    count
}
