//! One run of the bench, against the thesis.

use crate::results::Document;
use serde::Serialize;

use crate::results::{MeanStd, RunResult};
use crate::scene::Outcome;

use super::conditions::Conditions;
use super::thesis::{Reported, ThesisFigures, thesis_figures};

/// How a figure compares with the thesis's, by their means.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// At most the thesis's.
    Better,
    /// More, or not known.
    Worse,
}

/// The verdicts on the figures that the thesis reports of a scene; `None` on what it does not report, and on all of a run that did
/// not complete.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Verdicts {
    /// On the mean error.
    pub error_mm: Option<Verdict>,
    /// On the retrieval radius; also `None` for a run without retrievals, which cannot be worse at them.
    pub radius_mm: Option<Verdict>,
    /// On the axis error.
    pub axis_mm: Option<Verdict>,
}

/// One run of the bench, beside what the thesis reports of its scene.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct BenchRow {
    /// The run.
    #[serde(flatten)]
    pub result: RunResult,
    /// What makes it harder than the thesis's scenes are.
    pub conditions: Conditions,
    /// What the thesis reports; `None` of a scene that is not one of its own.
    pub thesis: Option<ThesisFigures>,
    /// How the two compare.
    pub verdicts: Verdicts,
    /// Whether the run completed, no figure is worse than the thesis's, and what the scenario expects holds; whether it completed,
    /// if conditions make it harder.
    pub passed: bool,
}

impl Document for BenchRow {
    const FORMAT: &'static str = "bench";
}

impl BenchRow {
    /// The row of a run, which is as its scenario expects if `holds`.
    #[must_use]
    pub fn new(result: RunResult, holds: bool) -> Self {
        let thesis = thesis_figures(&result.scenario).copied();
        let completed = result.outcome == Outcome::Completed;
        let verdict = |reported, found| verdict(reported, found).filter(|_| completed);
        let radius = result.retrieval.and_then(|retrieval| retrieval.radius_mm.mean);
        let axis = result.axis_mm.and_then(|axis| axis.mean);
        let verdicts = Verdicts {
            error_mm: verdict(thesis.map(|thesis| thesis.error_mm), result.error_mm.mean),
            radius_mm: radius.and_then(|radius| verdict(thesis.and_then(|thesis| thesis.radius_mm), Some(radius))),
            axis_mm: verdict(thesis.and_then(|thesis| thesis.axis_mm), axis),
        };
        let all = [verdicts.error_mm, verdicts.radius_mm, verdicts.axis_mm];
        let passed = completed && holds && !all.contains(&Some(Verdict::Worse));
        Self { result, conditions: Conditions::default(), thesis, verdicts, passed }
    }

    /// The same row as that of a run under `conditions`.
    #[must_use]
    pub fn under(self, conditions: Conditions) -> Self {
        let passed = if conditions.are_ideal() { self.passed } else { self.result.outcome == Outcome::Completed };
        Self { conditions, passed, ..self }
    }

    /// The scene, and the conditions if they make it harder.
    #[must_use]
    pub fn scene(&self) -> String {
        self.conditions.named(&self.result.scenario)
    }

    /// The figures that the thesis reports too: what was found, what it reports, and the verdict.
    pub(crate) fn figures(&self) -> [(MeanStd, Option<Reported>, Option<Verdict>); 3] {
        let error = MeanStd { mean: self.result.error_mm.mean, std: self.result.error_mm.std };
        let radius = self.result.retrieval.map(|retrieval| retrieval.radius_mm).unwrap_or_default();
        let axis = self.result.axis_mm.unwrap_or_default();
        let thesis = self.thesis.as_ref();
        [
            (error, thesis.map(|thesis| thesis.error_mm), self.verdicts.error_mm),
            (radius, thesis.and_then(|thesis| thesis.radius_mm), self.verdicts.radius_mm),
            (axis, thesis.and_then(|thesis| thesis.axis_mm), self.verdicts.axis_mm),
        ]
    }
}

fn verdict(reported: Option<Reported>, found: Option<f64>) -> Option<Verdict> {
    let reported = reported?;
    // What is not a number is no better.
    Some(if found.is_some_and(|found| found <= reported.mean) { Verdict::Better } else { Verdict::Worse })
}
