//! Latencies of the control loop as a table.

use super::super::table::Table;
use crate::study::latency::LatencyRow;

/// A table with a row for every scene, policy and phase. It has the times of a control tick, and the longest one as a
/// share of the control period. The last column includes interruptions by other programs.
#[must_use]
pub fn latency_table(rows: &[LatencyRow]) -> Table {
    let headings = [
        "scene",
        "policy",
        "phase",
        "ticks",
        "median µs",
        "p99 µs",
        "worst µs",
        "worst, % of period",
        "interrupted µs",
    ];
    let microseconds = |time: f64| format!("{:.1}", 1e6 * time);
    let cells = |row: &LatencyRow| {
        vec![
            row.scenario.clone(),
            row.policy.clone(),
            row.phase.clone(),
            row.ticks.to_string(),
            microseconds(row.median),
            microseconds(row.p99),
            microseconds(row.worst),
            format!("{:.3}", 100.0 * row.share),
            microseconds(row.longest),
        ]
    };
    Table::new(3, headings, rows.iter().map(cells))
}
