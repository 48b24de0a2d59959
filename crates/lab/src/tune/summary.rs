//! The result of a tuning.

use std::collections::BTreeMap;

use serde::Serialize;

use super::line::TunedRun;
use crate::results::Document;

/// The result of a tuning.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Tuning {
    /// The policy.
    pub policy: String,
    /// The weighted sum that costs are made of.
    pub objective: String,
    /// Number of training runs, of this and of earlier processes.
    pub runs: usize,
    /// Number of all runs that earlier processes had finished.
    pub resumed: usize,
    /// The tuned parameters.
    pub parameters: Vec<TunedParameter>,
    /// The figures of the policy's own values if others were given, of the given values and of the tuned values.
    pub values: Vec<TunedValues>,
}

impl Document for Tuning {
    const FORMAT: &'static str = "tuned";
}

/// A tuned parameter.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct TunedParameter {
    /// Its name.
    pub name: String,
    /// The range that was searched.
    pub range: String,
    /// The value in the policy.
    pub default: String,
    /// The value at the start of the search.
    pub given: String,
    /// The tuned value.
    pub tuned: String,
}

/// Values of the parameters with their figures.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct TunedValues {
    /// `default`, `given` or `tuned`.
    pub of: &'static str,
    /// The values.
    pub settings: BTreeMap<String, String>,
    /// Figures in the training scenes.
    pub training: TunedFigures,
    /// Figures in the held-out scenes.
    pub held_out: TunedFigures,
}

/// Figures over scenes. `None` without a run that has the figure.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct TunedFigures {
    /// Number of runs.
    pub runs: usize,
    /// Number of runs that passed.
    pub passed: usize,
    /// Mean cost of all runs.
    pub cost: Option<f64>,
    /// Mean weighted sum of the runs that passed.
    pub sum: Option<f64>,
    /// Mean error of the tip estimates, averaged over the runs that passed.
    pub error_mean_mm: Option<f64>,
    /// Mean simulated time of the runs that passed.
    pub time_s: Option<f64>,
}

impl TunedFigures {
    /// The figures over some runs.
    #[must_use]
    pub fn new(runs: &[TunedRun]) -> Self {
        let passed = || runs.iter().filter(|run| run.passed);
        Self {
            runs: runs.len(),
            passed: passed().count(),
            cost: mean(runs.iter().map(|run| run.cost)),
            sum: mean(passed().filter_map(|run| run.sum)),
            error_mean_mm: mean(passed().filter_map(|run| run.error_mean_mm)),
            time_s: mean(passed().map(|run| run.time_s)),
        }
    }
}

fn mean(values: impl Iterator<Item = f64>) -> Option<f64> {
    let (sum, count) = values.fold((0.0, 0_usize), |(sum, count), value| (sum + value, count + 1));
    (count > 0).then(|| sum / count as f64)
}
