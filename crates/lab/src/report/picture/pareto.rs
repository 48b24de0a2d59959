//! Settings as a picture.

use super::front::{FrontPoint, front_picture};
use crate::study::pareto::{Pareto, ParetoRow};

/// Kinds of changes, in the order of the picture's colours.
const AXES: [&str; 8] =
    ["links", "step", "contacts", "integrator", "solver", "world", "tip model", "default, fine, or several"];

/// A picture of run time against error: against the exact contour, against the fine run, and against the exact contour with
/// a wrong model of the array. Lines connect the Pareto-optimal settings. Filled points are Pareto-optimal in their world. Settings that did not complete
/// are omitted. A self-contained SVG.
#[must_use]
pub fn pareto_picture(pareto: &Pareto) -> String {
    let points: Vec<FrontPoint> = pareto.settings.iter().filter_map(point).collect();
    let title = format!("{}, policy {}: run time against error", pareto.scenario, pareto.policy);
    let subtitle = "lines: Pareto-optimal settings; filled: Pareto-optimal in its world; ring: the default";
    let errors = [
        "mean distance from the exact contour, mm",
        "mean distance from the contour of the fine run, mm",
        "mean distance from the exact contour with a mismatch, mm",
    ];
    front_picture(&title, subtitle, "run time over that of the default", errors, &AXES, &points)
}

/// The point of a setting that completed. An error of zero has no position on a logarithmic scale.
fn point(row: &ParetoRow) -> Option<FrontPoint> {
    let cost = row.relative_time.filter(|time| *time > 0.0)?;
    let error = |error: Option<f64>, on: bool, on_of_world: bool| {
        error.filter(|error| *error > 0.0 && row.met_its_stop()).map(|error| (error, on, on_of_world))
    };
    let (on, of_world) = (row.on_front, row.on_front_of_world);
    let errors = [
        error(row.error_mm, on.exact, of_world.exact),
        error(row.fine_mm, on.fine, of_world.fine),
        error(row.usable_mismatched_mm(), on.mismatched, of_world.mismatched),
    ];
    let kind = AXES.iter().position(|axis| *axis == row.axis).unwrap_or(AXES.len() - 1);
    row.met_its_stop().then(|| FrontPoint { name: row.setting.clone(), kind, cost, errors })
}
