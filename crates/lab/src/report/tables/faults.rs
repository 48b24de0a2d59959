//! Faults of a run as a table.

use super::super::table::{Table, known};
use crate::results::FaultRecord;

/// A table of faults with a row for each.
#[must_use]
pub fn faults_table(faults: &[FaultRecord]) -> Table {
    let time = |time: Option<f64>| known(time, |time| format!("{time:.3}"));
    Table::of(
        1,
        faults,
        &[
            ("fault", &|fault| fault.kind.clone()),
            ("part", &|fault| fault.part.to_string()),
            ("detected s", &|fault| time(Some(fault.detected_s))),
            ("stopped s", &|fault| time(fault.reacted_s)),
            ("recovered s", &|fault| time(fault.recovered_s)),
        ],
    )
}
