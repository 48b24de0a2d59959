//! Sources of the scenes of a sweep.

use crate::family::Family;
use vibrissa_world::scene::FileReference;

/// Scenes of one kind.
#[derive(Debug, Clone)]
pub struct SweepScenes {
    /// The family or the scenario.
    pub of: ScenesOf,
    /// Number of trials. They are numbered from 0.
    pub trials: u64,
    /// The seed, if one is given.
    pub seed: Option<u64>,
}

/// The source of the trials.
#[derive(Debug, Clone)]
pub enum ScenesOf {
    /// A family. Every trial is another scene.
    Family(Family),
    /// A scenario. Every trial has other noise.
    Scenario(FileReference),
}

impl SweepScenes {
    /// The name of the family or the scenario.
    #[must_use]
    pub fn name(&self) -> &str {
        match &self.of {
            ScenesOf::Family(family) => &family.name,
            ScenesOf::Scenario(file) => &file.name,
        }
    }

    /// `family` or `scenario`.
    pub(super) fn kind_word(&self) -> &'static str {
        match self.of {
            ScenesOf::Family(_) => "family",
            ScenesOf::Scenario(_) => "scenario",
        }
    }

    /// The seed of the family, 1 by default.
    #[must_use]
    pub fn family_seed(&self) -> u64 {
        self.seed.unwrap_or(1)
    }
}
