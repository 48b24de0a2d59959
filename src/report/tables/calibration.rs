//! The held-out errors of a calibration as a table.

use super::super::table::Table;
use crate::calibration::HeldOut;

/// A table of the errors of fits.
#[must_use]
pub(crate) fn held_out_table(rows: &[HeldOut]) -> Table {
    let cells = rows.iter().map(|row| {
        vec![
            row.model.to_owned(),
            row.sets.to_string(),
            format!("{:.3}", row.rms_mm),
            format!("{:.3}", row.max_mm),
            row.range.clone(),
        ]
    });
    Table::new(1, ["fit", "held-out sets", "rms mm", "max mm", "range"], cells)
}
