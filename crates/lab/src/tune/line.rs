//! The lines of the results of a tuning.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::candidate::Candidate;
use super::objective::{Objective, rounded};
use super::scenes::TuningScene;
use crate::results::Document;
use crate::trial::TrialResult;

/// The result of a run of a candidate, as a line.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct TuningLine {
    /// The scene.
    pub scene: String,
    /// The values of the tuned parameters.
    pub settings: BTreeMap<String, String>,
    /// The figures.
    #[serde(flatten)]
    pub run: TunedRun,
}

impl Document for TuningLine {
    const FORMAT: &'static str = "tuning-run";
}

/// The figures of a run that are compared.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct TunedRun {
    /// True if the run satisfied the expectations of its scene.
    pub passed: bool,
    /// Its cost.
    pub cost: f64,
    /// The weighted sum of its figures. `None` if it lacks one.
    pub sum: Option<f64>,
    /// Mean error of the tip estimates.
    pub error_mean_mm: Option<f64>,
    /// Simulated time.
    pub time_s: f64,
}

impl TunedRun {
    /// The figures of a run.
    pub fn new(objective: &Objective, result: &TrialResult) -> Self {
        let passed = result.violations.is_empty();
        Self {
            passed,
            cost: objective.cost(result, passed),
            sum: objective.sum(result).map(rounded),
            error_mean_mm: result.score.error.map(|error| rounded(1e3 * error.mean)),
            time_s: rounded(result.run.trace.ticks.last().map_or(0.0, |tick| tick.time)),
        }
    }
}

impl TuningLine {
    /// The line of a run.
    #[must_use]
    pub fn new(candidate: &Candidate, scene: &TuningScene, run: TunedRun) -> Self {
        Self { scene: scene.name.clone(), settings: candidate.settings(), run }
    }
}
