//! The bench as a table.

use crate::report::{NONE, mean_std, millimetres, ruled};

use super::row::{BenchRow, Verdict};

/// The columns of names, which stand to the left.
const NAMES: usize = 3;

/// The headings of the table's columns.
pub(super) const HEADINGS: [&str; 17] = [
    "scene",
    "policy",
    "outcome",
    "error mm",
    "thesis",
    "retrieval mm",
    "thesis",
    "axis mm",
    "thesis",
    "coverage",
    "corners",
    "corner mm",
    "corner s",
    "corner m",
    "collisions",
    "path m",
    "sim s",
];

/// A table of the bench, one line a run. Each figure that the thesis reports too says how it compares, and has the thesis's
/// beside it.
#[must_use]
pub fn bench_table(rows: &[BenchRow]) -> String {
    ruled(HEADINGS, rows.iter().map(|row| cells(row).map(|(text, _)| text).to_vec()), NAMES)
}

/// The cells of a line, with the verdict that a cell bears.
pub(super) fn cells(row: &BenchRow) -> [(String, Option<Verdict>); 17] {
    let result = &row.result;
    let plain = |text: Option<String>| (text.unwrap_or_else(|| NONE.to_owned()), None);
    let [error, radius, axis] = row.figures().map(|(found, reported, verdict)| {
        let found = found.mean.map(|mean| mean_std(mean, found.std));
        let reported = reported.map(|reported| match reported.std {
            Some(std) => format!("{} ± {}", reported.mean, std),
            None => reported.mean.to_string(),
        });
        let found = match (found, verdict) {
            (None, Some(_)) => Some("not known  worse".to_owned()),
            (found, Some(Verdict::Better)) => found.map(|found| found + " better"),
            // As wide as the other word, so that figures stand below each other.
            (found, Some(Verdict::Worse)) => found.map(|found| found + "  worse"),
            (found, None) => found,
        };
        [(plain(found).0, verdict), plain(reported)]
    });
    let [[error, thesis_error], [radius, thesis_radius], [axis, thesis_axis]] = [error, radius, axis];
    let corners = result.corners.as_ref();
    [
        plain(Some(row.scene())),
        plain(Some(result.policy.clone())),
        plain(Some(result.outcome.to_string())),
        error,
        thesis_error,
        radius,
        thesis_radius,
        axis,
        thesis_axis,
        plain(Some(format!("{:.1} %", 100.0 * result.coverage))),
        plain(corners.map(|corners| format!("{} of {}", corners.traced, corners.count))),
        plain(corners.and_then(|corners| corners.place_mm.mean).map(millimetres)),
        plain(corners.and_then(|corners| corners.time_s.mean).map(|time| format!("{time:.1}"))),
        plain(corners.and_then(|corners| corners.path_m.mean).map(|path| format!("{path:.2}"))),
        plain(Some(result.collisions.count.to_string())),
        plain(Some(format!("{:.2}", result.path_m))),
        plain(Some(format!("{:.1}", result.sim_s))),
    ]
}
