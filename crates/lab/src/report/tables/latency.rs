//! Latencies of the control loop as a table.

use super::super::table::Table;
use crate::study::latency::LatencyRow;

/// A table with a row for every scene, policy and phase. It has the times of a control tick, and the longest one as a
/// share of the control period. The last column includes interruptions by other programs.
#[must_use]
pub fn latency_table(rows: &[LatencyRow]) -> Table {
    let microseconds = |time: f64| format!("{:.1}", 1e6 * time);
    Table::of(
        3,
        rows,
        &[
            ("scene", &|row| row.scenario.clone()),
            ("policy", &|row| row.policy.clone()),
            ("phase", &|row| row.phase.clone()),
            ("ticks", &|row| row.ticks.to_string()),
            ("median µs", &|row| microseconds(row.median)),
            ("p99 µs", &|row| microseconds(row.p99)),
            ("worst µs", &|row| microseconds(row.worst)),
            ("worst, % of period", &|row| format!("{:.3}", 100.0 * row.share)),
            ("interrupted µs", &|row| microseconds(row.longest)),
        ],
    )
}
