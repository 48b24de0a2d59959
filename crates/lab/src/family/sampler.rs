//! The parameters of one scene: given values, and random numbers that are reproducible for each scene.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use rand_distr::{Distribution, StandardUniform};
use sha2::{Digest, Sha256};

use super::values::Values;
use vibrissa_declare::catalogue::Parameter;

/// The parameters of one scene. A given value replaces the random one and does not change the others.
#[derive(Debug, Clone)]
pub(super) struct Sampler<'v> {
    random: ChaCha8Rng,
    given: &'v Values,
}

impl<'v> Sampler<'v> {
    /// The parameters for a seed, with the `given` values.
    pub(super) fn new(seed: u64, given: &'v Values) -> Self {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        // The noise of the sensors has stream 0 of the same seed, starts have stream 1.
        random.set_stream(2);
        Self { random, given }
    }

    /// The value of a parameter, or a number that is sampled uniformly from its range.
    pub(super) fn number(&mut self, parameter: &Parameter) -> f64 {
        let (from, to) = parameter.range;
        self.number_or(parameter, |sampler| sampler.between(from, to))
    }

    /// The value of a parameter, or the result of `sample`.
    pub(super) fn number_or(&mut self, parameter: &Parameter, sample: impl FnOnce(&mut Self) -> f64) -> f64 {
        let random = sample(self);
        self.given.get(parameter).unwrap_or(random)
    }

    /// The value of a parameter that is a whole number.
    pub(super) fn whole(&mut self, parameter: &Parameter) -> u32 {
        let range = (natural(parameter.range.0), natural(parameter.range.1));
        let random = self.count(range.0, range.1);
        self.given.get(parameter).map_or(random, natural)
    }

    /// The value of a parameter that is −1 or +1.
    pub(super) fn side(&mut self, parameter: &Parameter) -> f64 {
        self.number_or(parameter, |sampler| if sampler.count(0, 1) == 0 { -1.0 } else { 1.0 })
    }

    /// A number that is sampled uniformly.
    pub(super) fn between(&mut self, from: f64, to: f64) -> f64 {
        let share: f64 = StandardUniform.sample(&mut self.random);
        from + share * (to - from)
    }

    /// An integer between two bounds, both included.
    pub(super) fn count(&mut self, from: u32, to: u32) -> u32 {
        let number: u32 = StandardUniform.sample(&mut self.random);
        from + number % (to - from + 1)
    }
}

/// The nearest whole number that is not negative.
fn natural(value: f64) -> u32 {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a cast saturates")]
    let number = value.round() as u32;
    number
}

/// The seed of a scene, independent of those of other families, seeds and trials.
pub(super) fn scene_seed(family: &str, seed: u64, trial: u64) -> u64 {
    let hash = Sha256::new().chain_update(family).chain_update([0]).chain_update(seed.to_le_bytes());
    let hash = hash.chain_update(trial.to_le_bytes()).finalize();
    hash.iter().take(8).fold(0, |seed, &byte| seed << 8 | u64::from(byte))
}
