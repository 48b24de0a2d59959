//! One run of the bench, compared with the baseline.

use crate::results::Document;
use serde::Serialize;

use crate::results::{Ending, RunResult};
use vibrissa_declare::figures::Metric;

use super::baseline::{BaselineFigures, Reported, baseline_figures};
use super::conditions::Conditions;

/// The comparison of the mean of a figure with the baseline's.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// At most the baseline's.
    Better,
    /// Greater than the baseline's, or unknown.
    Worse,
}

/// The verdicts on the figures that the baseline reports of a scene. `None` for other figures, and for all figures of a
/// run that did not meet its stop condition.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Verdicts {
    /// Verdict on the mean error.
    pub error_mm: Option<Verdict>,
    /// Verdict on the retrieval radius. `None` for a run without retrievals.
    pub radius_mm: Option<Verdict>,
    /// Verdict on the axis error.
    pub axis_mm: Option<Verdict>,
}

/// One run of the bench with the baseline's figures of its scene.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct BenchRow {
    /// The run.
    #[serde(flatten)]
    pub result: RunResult,
    /// The conditions of the run.
    pub conditions: Conditions,
    /// The baseline's figures. `None` for a scene that the baseline does not have.
    pub baseline: Option<BaselineFigures>,
    /// The verdicts.
    pub verdicts: Verdicts,
    /// True if the run completed, so that all expectations hold, and no figure is worse than the baseline's. With friction,
    /// noise or a mismatch, a completed run suffices.
    pub passed: bool,
}

impl Document for BenchRow {
    const FORMAT: &'static str = "bench";
    // The key of the baseline's figures was `thesis`.
    // In version 2, a run that met its stop condition but not all expectations was `completed`.
    const VERSION: u32 = 3;
}

impl BenchRow {
    /// The row of a run.
    #[must_use]
    pub fn new(result: RunResult) -> Self {
        let baseline = baseline_figures(&result.scenario).copied();
        let met_its_stop = result.outcome.met_its_stop();
        let verdict = |reported, found| verdict(reported, found).filter(|_| met_its_stop);
        let radius = result.figure(Metric::RetrievalRadius);
        let verdicts = Verdicts {
            error_mm: verdict(baseline.map(|baseline| baseline.error_mm), result.figure(Metric::ErrorMean)),
            radius_mm: radius
                .and_then(|radius| verdict(baseline.and_then(|baseline| baseline.radius_mm), Some(radius))),
            axis_mm: verdict(baseline.and_then(|baseline| baseline.axis_mm), result.figure(Metric::AxisMean)),
        };
        let all = [verdicts.error_mm, verdicts.radius_mm, verdicts.axis_mm];
        let passed =
            result.outcome == Ending::Completed && result.violations.is_empty() && !all.contains(&Some(Verdict::Worse));
        Self { result, conditions: Conditions::default(), baseline, verdicts, passed }
    }

    /// The same row for a run under `conditions`.
    #[must_use]
    pub fn under(self, conditions: Conditions) -> Self {
        let row = Self { conditions, ..self };
        let passed = if row.is_ideal() { row.passed } else { row.result.outcome == Ending::Completed };
        Self { passed, ..row }
    }

    /// True without friction, noise and mismatch.
    #[must_use]
    pub(crate) fn is_ideal(&self) -> bool {
        self.conditions.are_ideal() && self.result.mismatch.is_none()
    }

    /// The scene followed by the conditions, and by `mismatch` if there is one.
    #[must_use]
    pub fn scene(&self) -> String {
        let scene = self.conditions.named(&self.result.scenario);
        if self.result.mismatch.is_some() { format!("{scene}, mismatch") } else { scene }
    }

    /// The figures that the baseline reports too: the metric, the baseline's value, and the verdict.
    pub(crate) fn figures(&self) -> [(Metric, Option<Reported>, Option<Verdict>); 3] {
        let baseline = self.baseline.as_ref();
        [
            (Metric::ErrorMean, baseline.map(|baseline| baseline.error_mm), self.verdicts.error_mm),
            (Metric::RetrievalRadius, baseline.and_then(|baseline| baseline.radius_mm), self.verdicts.radius_mm),
            (Metric::AxisMean, baseline.and_then(|baseline| baseline.axis_mm), self.verdicts.axis_mm),
        ]
    }
}

fn verdict(reported: Option<Reported>, found: Option<f64>) -> Option<Verdict> {
    let reported = reported?;
    // A value that is not a number counts as worse.
    Some(if found.is_some_and(|found| found <= reported.mean) { Verdict::Better } else { Verdict::Worse })
}
