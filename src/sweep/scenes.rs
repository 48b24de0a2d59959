//! Where the scenes of a sweep come from.

use crate::family::Family;
use crate::scene::FileReference;

/// Scenes of one kind.
#[derive(Debug, Clone)]
pub struct SweepScenes {
    /// What they are.
    pub of: ScenesOf,
    /// How many trials there are, counted from 0.
    pub trials: u64,
    /// The seed, if one is given.
    pub seed: Option<u64>,
}

/// What the trials are trials of.
#[derive(Debug, Clone)]
pub enum ScenesOf {
    /// A family: every trial is a scene of its own.
    Family(Family),
    /// A scenario: every trial has noise of its own.
    Scenario(FileReference),
}

impl SweepScenes {
    /// The name of the family or the scenario.
    #[must_use]
    pub fn name(&self) -> &str {
        match &self.of {
            ScenesOf::Family(family) => family.name,
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

    /// The seed of the family; 1 unless another is given.
    #[must_use]
    pub fn family_seed(&self) -> u64 {
        self.seed.unwrap_or(1)
    }
}
