//! The bench as a table.

use crate::report::{NONE, mean_std, millimetres, percent, ruled};

use super::row::{BenchRow, Verdict};
use crate::study::TipShares;

/// The columns of names, which stand to the left.
const NAMES: usize = 3;

/// The headings of the table's columns.
pub(super) const HEADINGS: [&str; 20] = [
    "scene",
    "policy",
    "outcome",
    "error mm",
    "thesis",
    "retrieval mm",
    "thesis",
    "axis mm",
    "thesis",
    "outliers",
    "in 95 %",
    "coverage",
    "wall coverage",
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

/// A line for every policy: how many tips it recorded in all scenes together, which share of them are outliers, and which lies within
/// the 95 % interval that the tips report.
#[must_use]
pub fn pooled_tips(rows: &[BenchRow]) -> String {
    let mut policies: Vec<&str> = Vec::new();
    for row in rows {
        if !policies.contains(&row.result.policy.as_str()) {
            policies.push(&row.result.policy);
        }
    }
    let line = |policy: &str| {
        let mine = rows.iter().filter(|row| row.result.policy == policy).map(|row| &row.result.error_mm);
        let tips: TipShares = mine.map(|error| TipShares::of_run(error.n, error.outliers, error.within_band)).sum();
        let share = |share: Option<f64>, digits| share.map_or_else(|| NONE.to_owned(), |share| percent(share, digits));
        format!(
            "{policy}: {} tips, {} outliers, {} within their 95 % interval",
            tips.count,
            share(tips.outlier_share(), 3),
            share(tips.within_band_share(), 1)
        )
    };
    policies.into_iter().map(line).collect::<Vec<_>>().join("\n")
}

/// The cells of a line, with the verdict that a cell bears.
pub(super) fn cells(row: &BenchRow) -> [(String, Option<Verdict>); 20] {
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
        plain(result.error_mm.outliers.map(|share| percent(share, 2))),
        plain(result.error_mm.within_band.map(|share| percent(share, 1))),
        plain(Some(percent(result.coverage, 1))),
        plain(result.passage.map(|passage| percent(passage.wall_coverage, 1))),
        plain(corners.map(|corners| format!("{} of {}", corners.traced, corners.count))),
        plain(corners.and_then(|corners| corners.place_mm.mean).map(millimetres)),
        plain(corners.and_then(|corners| corners.time_s.mean).map(|time| format!("{time:.1}"))),
        plain(corners.and_then(|corners| corners.path_m.mean).map(|path| format!("{path:.2}"))),
        plain(Some(result.collisions.count.to_string())),
        plain(Some(format!("{:.2}", result.path_m))),
        plain(Some(format!("{:.1}", result.sim_s))),
    ]
}
