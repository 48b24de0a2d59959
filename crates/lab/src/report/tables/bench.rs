//! The bench as a table.

use super::super::table::{NONE, Table, known, percent};
use super::results::{corners, dead_whiskers, text};
use crate::results::TipShares;
use crate::study::bench::{BenchRow, Verdict};
use vibrissa_declare::figures::{Cell, Metric};

/// The number of columns that name a run and its verdict.
pub(in crate::report) const NAMES: usize = 4;

/// The text of a cell, with the verdict on its figure if the baseline reports it.
type BenchCell = (String, Option<Verdict>);

/// A column: its heading, and the cell of a row.
type BenchColumn = (&'static str, fn(&BenchRow) -> BenchCell);

/// The columns of the table.
pub(in crate::report) const COLUMNS: [BenchColumn; 23] = [
    ("scene", |row| plain(Some(row.scene()))),
    ("policy", |row| plain(Some(row.result.policy_label()))),
    ("outcome", |row| plain(Some(row.result.outcome.to_string()))),
    ("against the baseline", |row| plain(against_baseline(row))),
    ("error mm", |row| found(row, ERROR)),
    ("baseline: error mm", |row| reported(row, ERROR)),
    ("outliers", |row| decimals(row, Metric::Outliers, 2)),
    ("coverage", |row| decimals(row, Metric::Coverage, 1)),
    ("retrieval mm", |row| found(row, RETRIEVAL)),
    ("baseline: retrieval mm", |row| reported(row, RETRIEVAL)),
    ("axis mm", |row| found(row, AXIS)),
    ("baseline: axis mm", |row| reported(row, AXIS)),
    ("collisions", |row| decimals(row, Metric::Collisions, 0)),
    ("seem dead", |row| plain(dead_whiskers(&row.result))),
    ("wall coverage", |row| decimals(row, Metric::WallCoverage, 1)),
    ("in 95 % interval", |row| decimals(row, Metric::IntervalCoverage, 1)),
    ("corners", |row| plain(corners(&row.result))),
    ("corner position mm", |row| decimals(row, Metric::CornerPlace, 3)),
    ("corner time s", |row| decimals(row, Metric::CornerTime, 1)),
    ("corner path m", |row| decimals(row, Metric::CornerPath, 2)),
    ("path m", |row| decimals(row, Metric::Path, 2)),
    ("sim s", |row| decimals(row, Metric::SimulatedTime, 1)),
    ("simulator", |row| plain(Some(row.result.world.clone()))),
];
/// The indices of the figures that the baseline reports.
const ERROR: usize = 0;
const RETRIEVAL: usize = 1;
const AXIS: usize = 2;

/// A table of the bench with a row for every run. A cell shows whether a figure is worse than the baseline's, which is
/// in the next column.
#[must_use]
pub fn bench_table(rows: &[BenchRow]) -> Table {
    let cells = |row: &BenchRow| COLUMNS.map(|(_, cell)| cell(row).0).to_vec();
    Table::new(NAMES, COLUMNS.map(|(heading, _)| heading), rows.iter().map(cells))
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
        let share = |share, digits| known(share, |share| percent(share, digits));
        format!(
            "{policy}: {} tips, {} outliers, {} within their 95 % interval",
            tips.count,
            share(tips.outlier_share(), 3),
            share(tips.within_band_share(), 1)
        )
    };
    policies.into_iter().map(line).collect::<Vec<_>>().join("\n")
}

fn plain(text: Option<String>) -> BenchCell {
    (text.unwrap_or_else(|| NONE.to_owned()), None)
}

fn decimals(row: &BenchRow, metric: Metric, digits: usize) -> BenchCell {
    plain(text(&row.result, metric, Cell::Decimals(digits)))
}

/// A figure that the baseline reports, with its verdict.
fn found(row: &BenchRow, figure: usize) -> BenchCell {
    let (metric, _, verdict) = row.figures()[figure];
    (plain(text(&row.result, metric, Cell::Spread)).0, verdict)
}

/// The same figure of the baseline.
fn reported(row: &BenchRow, figure: usize) -> BenchCell {
    plain(row.figures()[figure].1.map(|reported| match reported.std {
        Some(std) => format!("{} ± {std}", reported.mean),
        None => reported.mean.to_string(),
    }))
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
