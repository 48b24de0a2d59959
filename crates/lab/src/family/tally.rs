//! Counts over the runs of one family.

use serde::Serialize;

use crate::results::{Figures, Tally};

use super::run::FamilyRun;

/// Counts over the runs of one family, or over those at one speed.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct FamilyTally {
    /// The family.
    pub family: String,
    /// The speed (m/s). `None` for all speeds together.
    pub speed: Option<f64>,
    /// The counts.
    #[serde(flatten)]
    pub tally: Tally,
}

impl FamilyTally {
    /// Counts the runs of a family at one speed, or at all speeds.
    #[must_use]
    pub fn new(family: &str, speed: Option<f64>, runs: &[FamilyRun]) -> Self {
        let is_counted =
            |run: &&FamilyRun| run.family == family && speed.is_none_or(|speed| (run.speed - speed).abs() < 1e-9);
        let figures = runs.iter().filter(is_counted).map(|run| Figures::new(&run.result));
        Self { family: family.to_owned(), speed, tally: Tally::new(figures) }
    }
}
