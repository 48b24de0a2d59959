//! The figures by which policies are compared.

use crate::results::RunResult;
use crate::scene::Outcome;

/// A figure of a run by which policies are compared.
#[derive(Debug, Clone, Copy)]
pub struct Figure {
    /// Its name, with its unit.
    pub name: &'static str,
    /// Its value in that unit. `None` if the run does not have it.
    pub of: fn(&RunResult) -> Option<f64>,
    /// True if larger values are better.
    pub larger_is_better: bool,
    /// True if runs that did not complete have it too.
    pub of_every_run: bool,
}

/// All figures, with the names of the result of a run. The last is 1 for a completed run and else 0, so that its mean
/// is a share.
pub const FIGURES: [Figure; 17] = [
    Figure {
        of_every_run: true,
        ..higher("completed", |result| Some(f64::from(u8::from(result.outcome == Outcome::Completed))))
    },
    lower("error_mm.mean", |result| result.error_mm.mean),
    lower("error_mm.p95", |result| result.error_mm.p95),
    lower("error_mm.max", |result| result.error_mm.max),
    higher("coverage", |result| Some(result.coverage)),
    lower("hausdorff_mm", |result| result.hausdorff_mm),
    lower("retrieval.radius_mm", |result| result.retrieval?.radius_mm.mean),
    lower("retrieval.distance_mm", |result| result.retrieval?.distance_mm.mean),
    lower("axis_mm", |result| result.axis_mm?.mean),
    higher("corners.traced", |result| Some(result.corners?.traced as f64)),
    lower("corners.place_mm", |result| result.corners?.place_mm.mean),
    lower("corners.angle_rad", |result| result.corners?.angle_rad.mean),
    lower("corners.time_s", |result| result.corners?.time_s.mean),
    lower("corners.path_m", |result| result.corners?.path_m.mean),
    lower("collisions", |result| Some(result.collisions.count as f64)),
    lower("path_m", |result| Some(result.path_m)),
    lower("sim_s", |result| Some(result.sim_s)),
];

const fn lower(name: &'static str, of: fn(&RunResult) -> Option<f64>) -> Figure {
    Figure { name, of, larger_is_better: false, of_every_run: false }
}

const fn higher(name: &'static str, of: fn(&RunResult) -> Option<f64>) -> Figure {
    Figure { larger_is_better: true, ..lower(name, of) }
}
