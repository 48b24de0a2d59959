//! The comparison of simulators as a table.

use super::super::number::{millimetres, significant};
use super::super::table::{NONE, Table};
use crate::study::worlds::WorldsRow;

const HEADINGS: [&str; 11] = [
    "scene",
    "policy",
    "simulation",
    "its run",
    "tip mm",
    "contour mm",
    "moment µN m",
    "of the moment",
    "left out",
    "p95 tip mm",
    "p95 moment µN m",
];

/// A table with a row for every scene, policy and simulation. It has the differences of tips and moments from the
/// reference (mean, 95th percentile), and the mean difference of the moments as a share of the moment. It also has the
/// distance of the contours, the share of ticks that are not compared, and the outcome of the policy's run.
#[must_use]
pub fn worlds_table(rows: &[WorldsRow]) -> Table {
    let shown = |value: Option<f64>, text: &dyn Fn(f64) -> String| value.map_or_else(|| NONE.to_owned(), text);
    let lines = rows.iter().map(|row| {
        vec![
            row.scenario.clone(),
            row.policy.clone(),
            row.simulation.to_owned(),
            row.outcome.name().to_owned(),
            shown(row.tip_mm.map(|tip| tip.mean), &millimetres),
            shown(row.contour_mm, &millimetres),
            shown(row.moment_un_m.map(|moment| moment.mean), &significant),
            shown(row.moment_share, &|share| format!("{:.2} %", 100.0 * share)),
            format!("{:.1} %", 100.0 * row.left_out),
            shown(row.tip_mm.map(|tip| tip.p95), &millimetres),
            shown(row.moment_un_m.map(|moment| moment.p95), &significant),
        ]
    });
    Table::new(4, HEADINGS, lines)
}
