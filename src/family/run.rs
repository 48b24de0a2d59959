//! One run in a scene of a family.

use crate::results::Document;
use serde::Serialize;

use crate::results::RunResult;

/// A run in one scene of a family.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct FamilyRun {
    /// The family.
    pub family: &'static str,
    /// Number of the scene within the family.
    pub trial: u64,
    /// Description of the scene.
    pub about: String,
    /// The speed of the scene (m/s).
    pub speed: f64,
    /// True if the run completed, traced its object, and the body touched nothing.
    pub passed: bool,
    /// Descriptions of what did not hold. Empty if the run passed.
    pub violations: Vec<String>,
    /// The result.
    #[serde(flatten)]
    pub result: RunResult,
}

impl Document for FamilyRun {
    const FORMAT: &'static str = "family-run";
}
