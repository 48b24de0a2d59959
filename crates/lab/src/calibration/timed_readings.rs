//! Files of readings of one whisker as comma-separated values.

use csv::{ReaderBuilder, Trim};
use serde::Deserialize;

use super::columns::check_columns;
use super::contact_sets::SetsError;

/// The columns of a file.
const COLUMNS: [&str; 2] = ["time_s", "base_angle_urad"];

/// Reads times (s, ascending) and base angles (rad) from comma-separated values. Lines that begin with `#` are ignored.
///
/// # Errors
/// [`SetsError`] with the first invalid line.
pub fn read_timed_readings(bytes: &[u8]) -> Result<Vec<(f64, f64)>, SetsError> {
    #[derive(Deserialize)]
    struct Row {
        time_s: f64,
        base_angle_urad: f64,
    }
    let mut reader = ReaderBuilder::new().trim(Trim::All).comment(Some(b'#')).from_reader(bytes);
    let refusal = |error: csv::Error| {
        let line = error.position().map_or(1, csv::Position::line);
        SetsError::new(line, "every line must have two numbers, a time and a base angle".to_owned())
    };
    let header = reader.headers().map_err(refusal)?.clone();
    check_columns(&header, &COLUMNS, &[], |_| "").map_err(|reason| SetsError::new(1, reason))?;
    let mut readings: Vec<(f64, f64)> = Vec::new();
    for record in reader.records() {
        let record = record.map_err(refusal)?;
        let line = record.position().map_or(0, csv::Position::line);
        let row: Row = record.deserialize(Some(&header)).map_err(refusal)?;
        if readings
            .last()
            .is_some_and(|(before, _)| row.time_s.partial_cmp(before) != Some(std::cmp::Ordering::Greater))
        {
            return Err(SetsError::new(line, "times must increase from line to line".to_owned()));
        }
        readings.push((row.time_s, 1e-6 * row.base_angle_urad));
    }
    Ok(readings)
}
