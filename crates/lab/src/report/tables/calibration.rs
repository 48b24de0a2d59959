//! The results of calibrations as tables.

use vibrissa_runtime::calibration::Parameter;

use super::super::number::millimetres;
use super::super::table::Table;
use crate::calibration::{HeldOut, WhiskerTouches};

/// A table of the errors of fits.
#[must_use]
pub fn held_out_table(rows: &[HeldOut]) -> Table {
    let cells = rows.iter().map(|row| {
        vec![
            row.model.to_owned(),
            row.sets.to_string(),
            millimetres(row.rms_mm),
            millimetres(row.max_mm),
            row.range.clone(),
        ]
    });
    Table::new(1, ["fit", "held-out sets", "rms mm", "max mm", "range"], cells)
}

/// The table of the whiskers that an array has measured by its own touches, as differences from the rig.
#[must_use]
pub fn measured_table(rows: &[WhiskerTouches]) -> Table {
    let cells = rows.iter().map(|row| {
        let fit = row.fit.as_ref().ok();
        let value = |parameter: Parameter, scale: f64| {
            fit.map_or_else(String::new, |fit| {
                let index = parameter.index();
                let deviation = fit.covariance[(index, index)].sqrt();
                format!("{:+.2} ± {:.2}", scale * fit.parameters[index], scale * deviation)
            })
        };
        vec![
            row.whisker.clone(),
            row.readings.len().to_string() + &row.time.map_or_else(String::new, |time| format!(" in {time:.0} s")),
            value(Parameter::Stiffness, 100.0),
            value(Parameter::Length, 1e3),
            value(Parameter::Direction, 1.0_f64.to_degrees()),
            value(Parameter::BaseX, 1e3),
            value(Parameter::BaseY, 1e3),
            value(Parameter::Curvature, 1.0),
            value(Parameter::Taper, 100.0),
            value(Parameter::Offset, 1e6),
            fit.map_or_else(|| "refused".to_owned(), |_| millimetres(1e3 * row.tip_deviation)),
        ]
    });
    let header = [
        "whisker",
        "touches",
        "hinge %",
        "length mm",
        "direction deg",
        "base x mm",
        "base y mm",
        "curvature 1/m",
        "taper %",
        "offset urad",
        "tip deviation mm",
    ];
    Table::new(1, header, cells)
}
