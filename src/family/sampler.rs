//! Random numbers that are reproducible for each scene.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use rand_distr::{Distribution, StandardUniform};
use sha2::{Digest, Sha256};

/// The random numbers of one scene.
#[derive(Debug, Clone)]
pub(super) struct Sampler(ChaCha8Rng);

impl Sampler {
    /// The random numbers of a seed.
    pub(super) fn new(seed: u64) -> Self {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        // The noise of the sensors has stream 0 of the same seed, starts have stream 1.
        random.set_stream(2);
        Self(random)
    }

    /// A number that is sampled uniformly.
    pub(super) fn between(&mut self, from: f64, to: f64) -> f64 {
        let share: f64 = StandardUniform.sample(&mut self.0);
        from + share * (to - from)
    }

    /// An integer between two bounds, both included.
    pub(super) fn count(&mut self, from: u32, to: u32) -> u32 {
        let number: u32 = StandardUniform.sample(&mut self.0);
        from + number % (to - from + 1)
    }

    /// −1 or +1.
    pub(super) fn side(&mut self) -> f64 {
        if self.count(0, 1) == 0 { -1.0 } else { 1.0 }
    }
}

/// The seed of a scene, independent of those of other families, seeds and trials.
pub(super) fn scene_seed(family: &str, seed: u64, trial: u64) -> u64 {
    let hash = Sha256::new().chain_update(family).chain_update([0]).chain_update(seed.to_le_bytes());
    let hash = hash.chain_update(trial.to_le_bytes()).finalize();
    hash.iter().take(8).fold(0, |seed, &byte| seed << 8 | u64::from(byte))
}
