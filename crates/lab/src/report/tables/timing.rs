//! Run times as a table.

use super::super::table::{NONE, Table};
use crate::study::timing::TimingRow;

/// A table with a row for every scene and policy. It has the ratio of simulated to processor time (median, least,
/// greatest), and the times of a control tick.
#[must_use]
pub fn timing_table(rows: &[TimingRow]) -> Table {
    let headings = [
        "scene",
        "policy",
        "world",
        "outcome",
        "× real time",
        "tick µs",
        "processor s",
        "start ms",
        "sim s",
        "p99 tick µs",
        "least × real time",
        "greatest × real time",
    ];
    let microseconds = |time: Option<f64>| time.map_or_else(|| NONE.to_owned(), |time| format!("{time:.1}"));
    let cells = |row: &TimingRow| {
        vec![
            row.scenario.clone(),
            row.policy.clone(),
            row.world.clone(),
            row.outcome.to_string(),
            format!("{:.0}", row.realtime),
            microseconds(row.tick_us.mean),
            format!("{:.3}", row.processor_s),
            format!("{:.1}", row.start_ms),
            format!("{:.1}", row.sim_s),
            microseconds(row.tick_us.p99),
            format!("{:.0}", row.realtime_range[0]),
            format!("{:.0}", row.realtime_range[1]),
        ]
    };
    Table::new(4, headings, rows.iter().map(cells))
}
