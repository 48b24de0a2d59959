//! The figures by which policies are compared.

use serde_json::Value;

use crate::results::{Ending, RunResult};

/// A figure of a run by which policies are compared.
#[derive(Debug, Clone, Copy)]
pub struct Figure {
    /// Its name, with its unit.
    pub name: &'static str,
    /// Its value in that unit. `None` if the run does not have it.
    pub of: fn(&RunResult) -> Option<f64>,
    /// Its position in the JSON document of a run.
    pointer: &'static str,
    /// True if larger values are better.
    pub larger_is_better: bool,
    /// True if runs that did not meet their stop condition have it too.
    pub of_every_run: bool,
}

impl Figure {
    /// Its value in the JSON document of a run. `None` if the run does not have it.
    pub(super) fn in_document(&self, run: &Value) -> Option<f64> {
        match run.pointer(self.pointer)? {
            Value::String(outcome) => Some(f64::from(u8::from(outcome == Ending::Completed.name()))),
            value => value.as_f64(),
        }
    }

    /// True if a run in a JSON document counts for the figure. The other figures of a run that did not meet its stop condition
    /// would mislead.
    pub(super) fn counts_in(&self, run: &Value) -> bool {
        let is = |ending: Ending| run.get("outcome").is_some_and(|outcome| outcome == ending.name());
        self.of_every_run || is(Ending::Completed) || is(Ending::Ended)
    }
}

/// All figures, with the names of the result of a run. The last is 1 for a completed run and else 0, so that its mean
/// is a share.
pub const FIGURES: [Figure; 17] = [
    Figure {
        of_every_run: true,
        ..higher("completed", "/outcome", |result| Some(f64::from(u8::from(result.outcome == Ending::Completed))))
    },
    lower("error_mm.mean", "/error_mm/mean", |result| result.error_mm.mean),
    lower("error_mm.p95", "/error_mm/p95", |result| result.error_mm.p95),
    lower("error_mm.max", "/error_mm/max", |result| result.error_mm.max),
    higher("coverage", "/coverage", |result| Some(result.coverage)),
    lower("hausdorff_mm", "/hausdorff_mm", |result| result.hausdorff_mm),
    lower("retrieval.radius_mm", "/retrieval/radius_mm/mean", |result| result.retrieval?.radius_mm.mean),
    lower("retrieval.distance_mm", "/retrieval/distance_mm/mean", |result| result.retrieval?.distance_mm.mean),
    lower("axis_mm", "/axis_mm/mean", |result| result.axis_mm?.mean),
    higher("corners.traced", "/corners/traced", |result| Some(result.corners?.traced as f64)),
    lower("corners.place_mm", "/corners/place_mm/mean", |result| result.corners?.place_mm.mean),
    lower("corners.angle_rad", "/corners/angle_rad/mean", |result| result.corners?.angle_rad.mean),
    lower("corners.time_s", "/corners/time_s/mean", |result| result.corners?.time_s.mean),
    lower("corners.path_m", "/corners/path_m/mean", |result| result.corners?.path_m.mean),
    lower("collisions", "/collisions/count", |result| Some(result.collisions.count as f64)),
    lower("path_m", "/path_m", |result| Some(result.path_m)),
    lower("sim_s", "/sim_s", |result| Some(result.sim_s)),
];

const fn lower(name: &'static str, pointer: &'static str, of: fn(&RunResult) -> Option<f64>) -> Figure {
    Figure { name, of, pointer, larger_is_better: false, of_every_run: false }
}

const fn higher(name: &'static str, pointer: &'static str, of: fn(&RunResult) -> Option<f64>) -> Figure {
    Figure { larger_is_better: true, ..lower(name, pointer, of) }
}
