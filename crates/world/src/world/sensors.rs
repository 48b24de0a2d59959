//! Simulated sensors.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;

use vibrissa_runtime::rig::Sensing;

use super::noise::Noise;

/// Smaller angles (rad) are read as 0. The vibration of a free whisker decays to subnormal numbers, which processors
/// handle a hundred times more slowly. All values computed from readings would be affected.
const FADED: f64 = 1e-290;

/// The sensors at the bases of whiskers, with noise and resolution. They are the same in all simulators.
#[derive(Debug, Clone)]
pub struct Sensors {
    noise: Noise,
    resolution: f64,
    force_noise: Noise,
    random: ChaCha8Rng,
}

impl Sensors {
    /// Creates the sensors. `seed` determines their noise.
    #[must_use]
    pub fn new(sensing: &Sensing, seed: u64) -> Self {
        Self {
            noise: Noise::new(sensing.angle_noise),
            resolution: sensing.angle_resolution,
            force_noise: Noise::new(sensing.force_noise),
            random: ChaCha8Rng::seed_from_u64(seed),
        }
    }

    /// Returns the reading of a base angle (rad).
    pub fn read(&mut self, base_angle: f64) -> f64 {
        let noisy = base_angle + self.noise.draw(&mut self.random);
        if self.resolution > 0.0 {
            (noisy / self.resolution).round() * self.resolution
        } else if noisy.abs() < FADED {
            0.0
        } else {
            noisy
        }
    }

    /// Returns the reading of a force (N) at the base.
    pub fn read_force(&mut self, force: f64) -> f64 {
        force + self.force_noise.draw(&mut self.random)
    }
}

/// Rounds to a positive count. Scenes are validated so that the value is nearly an integer.
#[must_use]
pub fn whole(value: f64) -> usize {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a validated small count")]
    let count = value.round().max(1.0) as usize;
    count
}
