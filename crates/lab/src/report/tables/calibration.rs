//! The results of calibrations as tables.

use vibrissa_runtime::calibration::Parameter;

use super::super::number::millimetres;
use super::super::table::Table;
use crate::calibration::{HeldOut, WhiskerTouches};

/// A table of the errors of fits.
#[must_use]
pub fn held_out_table(rows: &[HeldOut]) -> Table {
    Table::of(
        1,
        rows,
        &[
            ("fit", &|row| row.model.to_owned()),
            ("held-out sets", &|row| row.sets.to_string()),
            ("rms mm", &|row| millimetres(row.rms_mm)),
            ("max mm", &|row| millimetres(row.max_mm)),
            ("range", &|row| row.range.clone()),
        ],
    )
}

/// The table of the whiskers that an array has measured by its own touches, as differences from the rig.
#[must_use]
pub fn measured_table(rows: &[WhiskerTouches]) -> Table {
    let value = |row: &WhiskerTouches, parameter: Parameter, scale: f64| {
        row.fit.as_ref().map_or_else(
            |_| String::new(),
            |fit| {
                let index = parameter.index();
                let deviation = fit.covariance[(index, index)].sqrt();
                format!("{:+.2} ± {:.2}", scale * fit.parameters[index], scale * deviation)
            },
        )
    };
    let touches = |row: &WhiskerTouches| {
        row.readings.len().to_string() + &row.time.map_or_else(String::new, |time| format!(" in {time:.0} s"))
    };
    Table::of(
        1,
        rows,
        &[
            ("whisker", &|row| row.whisker.clone()),
            ("touches", &touches),
            ("hinge %", &|row| value(row, Parameter::Stiffness, 100.0)),
            ("length mm", &|row| value(row, Parameter::Length, 1e3)),
            ("direction deg", &|row| value(row, Parameter::Direction, 1.0_f64.to_degrees())),
            ("base x mm", &|row| value(row, Parameter::BaseX, 1e3)),
            ("base y mm", &|row| value(row, Parameter::BaseY, 1e3)),
            ("curvature 1/m", &|row| value(row, Parameter::Curvature, 1.0)),
            ("taper %", &|row| value(row, Parameter::Taper, 100.0)),
            ("offset urad", &|row| value(row, Parameter::Offset, 1e6)),
            ("tip deviation mm", &|row| match row.fit {
                Ok(_) => millimetres(1e3 * row.tip_deviation),
                Err(_) => "refused".to_owned(),
            }),
        ],
    )
}
