//! The comparison of simulators as a table.

use super::super::number::{millimetres, significant};
use super::super::table::{Table, known};
use crate::study::worlds::WorldsRow;

/// A table with a row for every scene, policy and simulation. It has the differences of tips and moments from the
/// reference (mean, 95th percentile), and the mean difference of the moments as a share of the moment. It also has the
/// distance of the contours, the share of ticks that are not compared, and the outcome of the policy's run.
#[must_use]
pub fn worlds_table(rows: &[WorldsRow]) -> Table {
    Table::of(
        4,
        rows,
        &[
            ("scene", &|row| row.scenario.clone()),
            ("policy", &|row| row.policy.clone()),
            ("simulation", &|row| row.simulation.to_owned()),
            ("its run", &|row| row.outcome.name().to_owned()),
            ("tip mm", &|row| known(row.tip_mm, |tip| millimetres(tip.mean))),
            ("contour mm", &|row| known(row.contour_mm, millimetres)),
            ("moment µN m", &|row| known(row.moment_un_m, |moment| significant(moment.mean))),
            ("of the moment", &|row| known(row.moment_share, |share| format!("{:.2} %", 100.0 * share))),
            ("left out", &|row| format!("{:.1} %", 100.0 * row.left_out)),
            ("p95 tip mm", &|row| known(row.tip_mm, |tip| millimetres(tip.p95))),
            ("p95 moment µN m", &|row| known(row.moment_un_m, |moment| significant(moment.p95))),
        ],
    )
}
