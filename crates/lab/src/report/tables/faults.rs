//! Faults of a run as a table.

use super::super::table::{NONE, Table};
use crate::results::FaultRecord;

/// A table of faults with a row for each.
#[must_use]
pub fn faults_table(faults: &[FaultRecord]) -> Table {
    let time = |time: Option<f64>| time.map_or_else(|| NONE.to_owned(), |time| format!("{time:.3}"));
    let rows = faults.iter().map(|fault| {
        let detected = time(Some(fault.detected_s));
        vec![fault.kind.clone(), fault.part.to_string(), detected, time(fault.reacted_s), time(fault.recovered_s)]
    });
    Table::new(1, ["fault", "part", "detected s", "stopped s", "recovered s"], rows)
}
