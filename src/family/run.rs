//! One run in a scene of a family.

use crate::results::Document;
use serde::Serialize;

use crate::results::RunResult;

/// A run in one scene of a family.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct FamilyRun {
    /// The family.
    pub family: &'static str,
    /// Which of the family's scenes.
    pub trial: u64,
    /// What the scene is like.
    pub about: String,
    /// The speed that it was drawn with (m/s).
    pub speed: f64,
    /// Whether it completed, traced its object, and the body touched nothing.
    pub passed: bool,
    /// What came of it.
    #[serde(flatten)]
    pub result: RunResult,
}

impl Document for FamilyRun {
    const FORMAT: &'static str = "family-run";
}
