//! The bench as a table.

use super::super::table::{NONE, Table, percent};
use super::results::{corners, dead_whiskers, text};
use crate::results::TipShares;
use crate::study::bench::{BenchRow, Verdict};
use vibrissa_declare::figures::{Cell, Metric};

/// The number of columns that name a run and its verdict.
pub(in crate::report) const NAMES: usize = 4;

/// The headings of the table's columns.
pub(in crate::report) const HEADINGS: [&str; 23] = [
    "scene",
    "policy",
    "outcome",
    "against the baseline",
    "error mm",
    "baseline: error mm",
    "outliers",
    "coverage",
    "retrieval mm",
    "baseline: retrieval mm",
    "axis mm",
    "baseline: axis mm",
    "collisions",
    "seem dead",
    "wall coverage",
    "in 95 % interval",
    "corners",
    "corner position mm",
    "corner time s",
    "corner path m",
    "path m",
    "sim s",
    "simulator",
];

/// A table of the bench with a row for every run. A cell shows whether a figure is worse than the baseline's, which is
/// in the next column.
#[must_use]
pub fn bench_table(rows: &[BenchRow]) -> Table {
    Table::new(NAMES, HEADINGS, rows.iter().map(|row| cells(row).map(|(text, _)| text).to_vec()))
}

/// A line for every policy over all scenes: the number of recorded tips, the share of outliers, and the share within
/// the 95 % interval that the tips report.
#[must_use]
pub fn pooled_tips(rows: &[BenchRow]) -> String {
    let mut policies: Vec<String> = Vec::new();
    for row in rows {
        let policy = row.result.policy_label();
        if !policies.contains(&policy) {
            policies.push(policy);
        }
    }
    let line = |policy: String| {
        let mine = rows.iter().map(|row| &row.result).filter(|result| result.policy_label() == policy);
        let tips: TipShares = mine.map(|result| TipShares::of_figures(|metric| result.figure(metric))).sum();
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

/// The cells of a row, with the verdict on each figure that the baseline reports.
pub(in crate::report) fn cells(row: &BenchRow) -> [(String, Option<Verdict>); 23] {
    let result = &row.result;
    let plain = |text: Option<String>| (text.unwrap_or_else(|| NONE.to_owned()), None);
    let [error, radius, axis] = row.figures().map(|(found, reported, verdict)| {
        let found = plain(text(result, found, Cell::Spread)).0;
        let reported = reported.map(|reported| match reported.std {
            Some(std) => format!("{} ± {}", reported.mean, std),
            None => reported.mean.to_string(),
        });
        [(found, verdict), plain(reported)]
    });
    let [[error, baseline_error], [radius, baseline_radius], [axis, baseline_axis]] = [error, radius, axis];
    let decimals = |metric, digits| plain(text(result, metric, Cell::Decimals(digits)));
    [
        plain(Some(row.scene())),
        plain(Some(result.policy_label())),
        plain(Some(result.outcome.to_string())),
        plain(against_baseline(row)),
        error,
        baseline_error,
        decimals(Metric::Outliers, 2),
        decimals(Metric::Coverage, 1),
        radius,
        baseline_radius,
        axis,
        baseline_axis,
        decimals(Metric::Collisions, 0),
        plain(dead_whiskers(result)),
        decimals(Metric::WallCoverage, 1),
        decimals(Metric::IntervalCoverage, 1),
        plain(corners(result)),
        decimals(Metric::CornerPlace, 3),
        decimals(Metric::CornerTime, 1),
        decimals(Metric::CornerPath, 2),
        decimals(Metric::Path, 2),
        decimals(Metric::SimulatedTime, 1),
        plain(Some(result.world.clone())),
    ]
}

/// The comparison with the baseline: whether all its figures are better, or the names of those that are worse.
fn against_baseline(row: &BenchRow) -> Option<String> {
    let verdicts = row.figures().map(|(.., verdict)| verdict);
    let worse = ["error", "retrieval", "axis"].into_iter().zip(verdicts);
    let worse: Vec<_> = worse.filter(|(_, verdict)| *verdict == Some(Verdict::Worse)).map(|(name, _)| name).collect();
    match verdicts.iter().flatten().count() {
        0 => None,
        _ if worse.is_empty() => Some("better".to_owned()),
        _ => Some(format!("worse: {}", worse.join(", "))),
    }
}
