//! Options that are given and have no effect.

use vibrissa_world::mismatch::Mismatch;
use vibrissa_world::scene::Scene;

/// An option that was given although nothing depends on it: a seed, or that arrays are not calibrated.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum WithoutEffect {
    /// The seed of the values of a mismatch.
    #[error(
        "the seed of the mismatch has no effect, because no value of a mismatch is a range; leave it out, or give \
         ranges as in scenarios/mismatch/array.yaml"
    )]
    Mismatch,
    /// That arrays are not calibrated.
    #[error(
        "--uncalibrated has no effect, because no array differs from the one that control assumes; leave it out, or give a mismatch: \
         --mismatch plausible"
    )]
    Uncalibrated,
    /// The seed of the cases of properties.
    #[error("the seed of the cases (--seed) has no effect, because no property is tested; leave it out")]
    Cases,
    /// The seed of the noise.
    #[error(
        "the seed of the noise has no effect, because nothing has noise; leave it out, or add noise: `rig.sensing` of a scenario, \
         `sensor` and `pose` of a mismatch, or the noise that `bench` and `calibrate` take"
    )]
    Noise,
}

/// Checks that a seed of the noise, if one is given, changes a run of one of the scenes.
///
/// # Errors
/// [`WithoutEffect`] if nothing has noise.
pub fn check_noise_seed<'s>(
    seed: Option<u64>,
    mut scenes: impl Iterator<Item = &'s Scene>,
) -> Result<(), WithoutEffect> {
    if seed.is_none() || scenes.any(Scene::is_noisy) { Ok(()) } else { Err(WithoutEffect::Noise) }
}

/// Checks that a seed of a mismatch, if one is given, changes the array of one of the scenes.
pub(super) fn check_mismatch_seed<'s>(
    seed: Option<u64>,
    file: Option<&Mismatch>,
    scenes: impl Iterator<Item = &'s Scene>,
) -> Result<(), WithoutEffect> {
    let mut mismatches = file.into_iter().chain(scenes.filter_map(|scene| scene.mismatch.as_ref()));
    if seed.is_none() || mismatches.any(Mismatch::is_drawn) { Ok(()) } else { Err(WithoutEffect::Mismatch) }
}
