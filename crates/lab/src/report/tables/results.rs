//! Results of runs as a table.

use super::super::number::{mean_std, millimetres};
use super::super::table::{NONE, Table, percent};
use crate::results::{Inclination, MeanStd, RunResult};

/// A column: its heading, its text for a run, and whether it is shown even if no run has the figure.
type Column = (&'static str, fn(&RunResult) -> Option<String>, bool);

/// The columns from left to right.
const COLUMNS: [Column; 29] = [
    ("scene", |result| Some(result.scenario.clone()), true),
    ("policy", |result| Some(result.policy_label()), true),
    ("outcome", |result| Some(result.outcome.to_string()), true),
    ("error mm", |result| Some(mean_std(result.error_mm.mean?, result.error_mm.std)), true),
    ("largest error mm", |result| result.error_mm.max.map(millimetres), true),
    ("outliers", |result| result.error_mm.outliers.map(|share| percent(share, 2)), true),
    ("coverage", |result| Some(percent(result.coverage, 1)), true),
    ("passage", |result| Some(percent(result.passage?.share, 1)), false),
    ("wall coverage", |result| Some(percent(result.passage?.wall_coverage, 1)), false),
    ("coverage of outlines", |result| outlines(&result.outline_coverages), false),
    ("collisions", |result| (result.collisions.count > 0).then(|| result.collisions.count.to_string()), false),
    ("seem dead", |result| dead_whiskers(result), false),
    ("out of plane mm", |result| Some(millimetres(result.out_of_plane.as_ref()?.max_mm)), false),
    ("slips", |result| Some(result.out_of_plane.as_ref()?.slips.to_string()), false),
    ("farthest untraced mm", |result| result.hausdorff_mm.map(millimetres), true),
    ("× real time", |result| result.realtime.map(|realtime| format!("{realtime:.0}")), true),
    ("sim s", |result| Some(format!("{:.1}", result.sim_s)), true),
    ("in 95 % interval", |result| result.error_mm.within_band.map(|share| percent(share, 1)), true),
    ("p95 error mm", |result| result.error_mm.p95.map(millimetres), true),
    ("axis mm", |result| mean_with_std(result.axis_mm?), false),
    ("corners", |result| result.corners.map(|corners| format!("{} of {}", corners.traced, corners.count)), false),
    ("corner position mm", |result| result.corners?.place_mm.mean.map(millimetres), false),
    ("corner time s", |result| result.corners?.time_s.mean.map(|time| format!("{time:.1}")), false),
    ("corner path m", |result| result.corners?.path_m.mean.map(|path| format!("{path:.2}")), false),
    ("retrieval radius mm", |result| mean_with_std(result.retrieval?.radius_mm), false),
    ("retrieval distance mm", |result| mean_with_std(result.retrieval?.distance_mm), false),
    ("beyond inclination limit s", |result| beyond_inclination_limit(result.inclination.as_ref()?), false),
    ("simulator", |result| Some(result.world.clone()), true),
    ("tick µs", |result| result.tick_us.mean.map(|mean| format!("{mean:.1}")), true),
];

/// A table of results with a row for each. A figure that some runs lack, such as corners, has a column if one run has
/// it.
#[must_use]
pub fn results_table(results: &[RunResult]) -> Table {
    let shown = |&&(_, text, always): &&Column| always || results.iter().any(|result| text(result).is_some());
    let columns: Vec<_> = COLUMNS.iter().filter(shown).collect();
    let cell = |text: Option<String>| text.unwrap_or_else(|| NONE.to_owned());
    let rows = results.iter().map(|result| columns.iter().map(|(_, text, _)| cell(text(result))).collect());
    Table::new(3, columns.iter().map(|(heading, ..)| *heading), rows)
}

fn mean_with_std(figure: MeanStd) -> Option<String> {
    Some(mean_std(figure.mean?, figure.std))
}

/// The coverage of each outline, if there are several.
fn outlines(coverages: &[f64]) -> Option<String> {
    (coverages.len() > 1).then(|| coverages.iter().map(|&coverage| percent(coverage, 1)).collect::<Vec<_>>().join(", "))
}

/// The whiskers that seem dead or insensitive, if there are any.
pub(super) fn dead_whiskers(result: &RunResult) -> Option<String> {
    let names: Vec<_> = result.dead_whiskers().map(|whisker| whisker.whisker.as_str()).collect();
    (!names.is_empty()).then(|| names.join(", "))
}

/// The time beyond the limit of the inclination, if there is any.
fn beyond_inclination_limit(inclination: &Inclination) -> Option<String> {
    (inclination.beyond_s > 0.0).then(|| format!("{:.1}", inclination.beyond_s))
}
