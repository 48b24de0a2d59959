//! Run times as a table.

use super::super::table::{Table, known};
use crate::study::timing::TimingRow;

/// A table with a row for every scene and policy. It has the ratio of simulated to processor time (median, least,
/// greatest), and the times of a control tick.
#[must_use]
pub fn timing_table(rows: &[TimingRow]) -> Table {
    let microseconds = |time: Option<f64>| known(time, |time| format!("{time:.1}"));
    Table::of(
        4,
        rows,
        &[
            ("scene", &|row| row.scenario.clone()),
            ("policy", &|row| row.policy.clone()),
            ("simulator", &|row| row.world.clone()),
            ("outcome", &|row| row.outcome.to_string()),
            ("× real time", &|row| format!("{:.0}", row.realtime)),
            ("tick µs", &|row| microseconds(row.tick_us.mean)),
            ("processor s", &|row| format!("{:.3}", row.processor_s)),
            ("start ms", &|row| format!("{:.1}", row.start_ms)),
            ("sim s", &|row| format!("{:.1}", row.sim_s)),
            ("p99 tick µs", &|row| microseconds(row.tick_us.p99)),
            ("least × real time", &|row| format!("{:.0}", row.realtime_range[0])),
            ("greatest × real time", &|row| format!("{:.0}", row.realtime_range[1])),
        ],
    )
}
