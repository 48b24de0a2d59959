//! Files of contact sets as comma-separated values.

use std::f64::consts::PI;
use std::fmt::Write;

use csv::{ReaderBuilder, StringRecord, Trim};
use vibrissa_runtime::calibration::ContactSet;

use super::columns::check_columns;
use super::count_set::CountSet;
use vibrissa_world::geometry::Vector2;

/// The error of a file of contact sets or of touches.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("line {line}: {reason}")]
pub struct SetsError {
    line: u64,
    reason: String,
}

impl SetsError {
    /// The error of a line, from 1.
    pub(super) fn new(line: u64, reason: String) -> Self {
        Self { line, reason }
    }
}

/// The columns of a file of sets: the required ones beside the reading, and the optional ones.
const POSITION: [&str; 2] = ["x_mm", "y_mm"];
const OPTIONAL: [&str; 2] = ["normal_deg", "contact"];
/// Largest distance of a contact from the base (mm), and the largest base angle (µrad): half a turn of the hinge.
const MAX_DISTANCE: f64 = 1e4;
const GREATEST_ANGLE: f64 = 1e6 * PI;
/// The columns with the reading: the base angle (µrad), or the counts of the sensor.
const ANGLE: &str = "base_angle_urad";
const COUNTS: &str = "counts";
/// Largest magnitude of the counts of a sensor.
const MAX_COUNTS: f64 = 32_768.0;
/// Largest magnitude of a direction (degrees).
const FULL_TURN: f64 = 360.0;

/// Reads contact sets from comma-separated values: a header with the names of columns in any order, and one set in each
/// line. `x_mm`, `y_mm` and `base_angle_urad` are required. `normal_deg` and `contact` (`tip` or `shaft`) are optional.
///
/// # Errors
/// [`SetsError`] with the first invalid line.
pub fn read_sets(bytes: &[u8]) -> Result<Vec<ContactSet>, SetsError> {
    let rows = read_rows(bytes, ANGLE, GREATEST_ANGLE)?;
    Ok(rows.into_iter().map(|(set, angle)| ContactSet { base_angle: 1e-6 * angle, ..set }).collect())
}

/// Reads contact sets whose reading is the column `counts`, the value of the sensor, in place of `base_angle_urad`.
///
/// # Errors
/// [`SetsError`] with the first invalid line.
pub fn read_count_sets(bytes: &[u8]) -> Result<Vec<CountSet>, SetsError> {
    let rows = read_rows(bytes, COUNTS, MAX_COUNTS)?;
    let counted = |(ContactSet { contact_base, normal, on_shaft, .. }, counts)| CountSet {
        contact_base,
        counts,
        normal,
        on_shaft,
    };
    Ok(rows.into_iter().map(counted).collect())
}

/// Reads lines with a column `reading`, whose values are at most `most`. The base angle of the sets is 0.
fn read_rows(bytes: &[u8], reading: &str, most: f64) -> Result<Vec<(ContactSet, f64)>, SetsError> {
    let mut reader = ReaderBuilder::new().trim(Trim::All).comment(Some(b'#')).from_reader(bytes);
    let refusal = |error: &csv::Error| SetsError {
        line: error.position().map_or(1, csv::Position::line),
        reason: "every line must be UTF-8 text with as many values as the header has names".to_owned(),
    };
    let header = reader.headers().map_err(|error| refusal(&error))?.clone();
    let advice = |name: &str| match (name, reading) {
        (COUNTS, ANGLE) => ". Counts need the settings of the sensor: give --config and --neutral",
        (ANGLE, COUNTS) => ". Base angles need no settings of a sensor: leave out --config and --neutral",
        _ => "",
    };
    let [x, y] = POSITION;
    check_columns(&header, &[x, y, reading], &OPTIONAL, advice).map_err(|reason| SetsError { line: 1, reason })?;
    let column = |name: &str| header.iter().position(|found| found == name);
    let mut sets = Vec::new();
    for record in reader.records() {
        let record = record.map_err(|error| refusal(&error))?;
        let line = record.position().map_or(0, csv::Position::line);
        if sets.len() == ContactSet::MOST {
            return Err(SetsError {
                line,
                reason: format!("there are more than {} sets; leave some out", ContactSet::MOST),
            });
        }
        sets.push(read(&record, &column, (reading, most)).map_err(|reason| SetsError { line, reason })?);
    }
    Ok(sets)
}

fn read(
    record: &StringRecord,
    column: &impl Fn(&str) -> Option<usize>,
    (reading, most): (&str, f64),
) -> Result<(ContactSet, f64), String> {
    let field = |name: &str| column(name).and_then(|index| record.get(index)).unwrap_or_default().to_owned();
    let number = |name: &str, most: f64| {
        let number: Option<f64> = field(name).parse().ok().filter(|number: &f64| number.abs() <= most);
        number
            .ok_or_else(|| format!("`{name}` must be a number from -{most:.0} to {most:.0}, and is `{}`", field(name)))
    };
    let normal = match field("normal_deg").as_str() {
        "" => None,
        _ => Some(number("normal_deg", FULL_TURN)?.to_radians()),
    };
    let on_shaft = match field("contact").as_str() {
        "" | "tip" => false,
        "shaft" => true,
        other => return Err(format!("`contact` must be `tip` or `shaft`, and is `{other}`")),
    };
    let contact_base = Vector2::new(number("x_mm", MAX_DISTANCE)?, number("y_mm", MAX_DISTANCE)?) * 1e-3;
    Ok((ContactSet { contact_base, base_angle: 0.0, normal, on_shaft }, number(reading, most)?))
}

/// Writes sets as comma-separated values.
#[must_use]
pub fn write_sets(sets: &[ContactSet]) -> String {
    let mut text = String::from("x_mm,y_mm,base_angle_urad,normal_deg,contact\n");
    for ContactSet { contact_base, base_angle, normal, on_shaft } in sets {
        let (x, y, angle) = (1e3 * contact_base.x, 1e3 * contact_base.y, 1e6 * base_angle);
        let normal = normal.map_or_else(String::new, |normal| format!("{:.3}", normal.to_degrees()));
        let contact = if *on_shaft { "shaft" } else { "tip" };
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{x:.4},{y:.4},{angle:.4},{normal},{contact}");
    }
    text
}
