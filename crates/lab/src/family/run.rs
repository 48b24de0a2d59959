//! One run in a scene of a family.

use crate::results::Document;
use serde::Serialize;

use crate::results::RunResult;

/// A run in one scene of a family.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct FamilyRun {
    /// The family.
    pub family: String,
    /// Number of the scene within the family.
    pub trial: u64,
    /// Description of the scene.
    pub about: String,
    /// The speed of the scene (m/s).
    pub speed: f64,
    /// True if the run completed, traced its object, the body touched nothing, and no recorded tip is more than 2 mm off.
    pub passed: bool,
    /// The result.
    #[serde(flatten)]
    pub result: RunResult,
}

impl Document for FamilyRun {
    const FORMAT: &'static str = "family-run";
    // A run passed with any tips, and a run that met only its stop condition was `completed`.
    const VERSION: u32 = 2;
}
