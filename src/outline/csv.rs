//! CSV: one corner per line.

use csv::{ReaderBuilder, StringRecord, Trim};

use crate::diagnostic::utf8;
use crate::geometry::{Piece, Point2};

use super::outline_list::{Outline, OutlineList};
use super::transform::Transform;
use super::{MAX_PIECES, OutlineError, OutlineFault, ReadOptions};

/// Reads a polygon with x and y in each line, with or without a header. The first corner may be repeated at the end.
pub(super) fn read(bytes: &[u8], options: &ReadOptions<'_>) -> Result<Vec<Outline>, OutlineError> {
    let transform = Transform::scaled(options.unit.ok_or(OutlineFault::NoUnit)?);
    let text = utf8(bytes).map_err(OutlineFault::NotUtf8)?;
    let mut reader =
        ReaderBuilder::new().has_headers(false).flexible(true).trim(Trim::All).from_reader(text.as_bytes());
    let mut corners: Vec<Point2> = Vec::new();
    let mut first_line = None;
    for (index, record) in reader.records().enumerate() {
        let record = record.map_err(|error| refusal(&error))?;
        let line = line(record.position());
        let place = place(&record);
        let Some(place) = place else {
            if index == 0 && is_header(&record) {
                continue;
            }
            let reason = format!("expected two numbers, x and y, found `{}`", shown(&record));
            return Err(OutlineFault::Syntax { reason }.at(line));
        };
        let corner = transform.point(place).map_err(|fault| fault.at(line))?;
        if corners.len() > MAX_PIECES {
            return Err(OutlineFault::TooLarge { what: "corners", limit: MAX_PIECES }.at(line));
        }
        first_line = first_line.or(line);
        corners.push(corner);
    }
    if corners.len() > 1 && corners.first() == corners.last() {
        corners.pop();
    }
    if corners.len() < 3 {
        return Err(OutlineFault::Corners { count: corners.len() }.at(first_line));
    }
    let ends = corners.iter().cycle().skip(1);
    let sides = corners.iter().zip(ends).map(|(&start, &end)| Piece::segment(start, end));
    let mut outlines = OutlineList::default();
    outlines.add(sides.collect(), first_line)?;
    outlines.into_outlines()
}

fn place(record: &StringRecord) -> Option<[f64; 2]> {
    let mut fields = record.iter();
    let (x, y) = (fields.next()?, fields.next()?);
    if fields.next().is_some() { None } else { Some([x.parse().ok()?, y.parse().ok()?]) }
}

/// True if no field begins like a number.
fn is_header(record: &StringRecord) -> bool {
    record.len() == 2
        && record.iter().all(|field| field.starts_with(|letter: char| letter.is_alphabetic() || letter == '_'))
}

/// A record for a message, truncated to a readable length.
fn shown(record: &StringRecord) -> String {
    let text = record.iter().collect::<Vec<_>>().join(",");
    text.chars().filter(|letter| !letter.is_control()).take(40).collect()
}

fn line(position: Option<&csv::Position>) -> Option<usize> {
    position.and_then(|position| usize::try_from(position.line()).ok())
}

fn refusal(error: &csv::Error) -> OutlineError {
    OutlineFault::Syntax { reason: error.to_string() }.at(line(error.position()))
}
