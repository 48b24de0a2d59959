//! CSV: one corner per line.

use csv::{ReaderBuilder, StringRecord, Trim};

use crate::geometry::{Piece, Point2};
use vibrissa_text::diagnostic::utf8;

use super::outline_list::{Outline, OutlineList};
use super::text::{lines, shown};
use super::transform::Transform;
use super::{MAX_PIECES, OutlineError, OutlineFault, ReadOptions};

/// What a comment begins with.
const COMMENT: char = '#';

/// Reads polygons with x and y in each line. A blank line separates two polygons. Each may have a header, and may repeat its first
/// corner at its end.
pub(super) fn read(bytes: &[u8], options: &ReadOptions<'_>) -> Result<Vec<Outline>, OutlineError> {
    let transform = Transform::scaled(options.unit.ok_or(OutlineFault::NoUnit)?);
    let text = utf8(bytes).map_err(OutlineFault::NotUtf8)?;
    let mut outlines = OutlineList::default();
    let mut polygon = Polygon::default();
    let mut separator = None;
    let mut count = 0;
    for (line, text) in lines(text) {
        let text = text.trim();
        if text.starts_with(COMMENT) {
            // With fewer corners, the polygon goes on behind the comment.
            polygon.comment = Some(line).filter(|_| polygon.corners.len() > 2);
            continue;
        }
        if let Some(stated) = stated_separator(text).filter(|_| separator.is_none()) {
            separator = Some(stated);
            continue;
        }
        // A row of empty cells is how a spreadsheet writes a blank line.
        if text.chars().all(|letter| letter.is_whitespace() || matches!(letter, ',' | ';' | '"')) {
            // A header may be separated from its polygon.
            if !polygon.corners.is_empty() {
                std::mem::take(&mut polygon).finish(&mut outlines)?;
            }
            continue;
        }
        let separator = *separator.get_or_insert_with(|| separator_of(text));
        let row = Row::of(text, separator).map_err(|fault| fault.at(Some(line)))?;
        let Some(place) = row.place() else {
            if !polygon.has_header && polygon.corners.is_empty() && row.is_header() {
                polygon.has_header = true;
                continue;
            }
            let reason = format!("expected two numbers, x and y, found `{}`", shown(text));
            return Err(OutlineFault::Syntax { reason }.at(Some(line)));
        };
        if let Some(line) = polygon.comment {
            // It may be the title of another polygon, which must not become a part of this one.
            let reason = "a comment within a polygon; write a blank line before it if another polygon begins there, or remove it";
            return Err(OutlineFault::Syntax { reason: reason.to_owned() }.at(Some(line)));
        }
        count += 1;
        if count > MAX_PIECES + 1 {
            return Err(OutlineFault::TooLarge { what: "corners", limit: MAX_PIECES }.at(Some(line)));
        }
        polygon.line = polygon.line.or(Some(line));
        polygon.corners.push(transform.point(place).map_err(|fault| fault.at(Some(line)))?);
    }
    if count == 0 || !polygon.corners.is_empty() {
        polygon.finish(&mut outlines)?;
    }
    outlines.into_outlines()
}

/// The polygon that is being read.
#[derive(Default)]
struct Polygon {
    has_header: bool,
    corners: Vec<Point2>,
    /// The line of its first corner.
    line: Option<usize>,
    /// The line of the last comment behind the third corner or a later one.
    comment: Option<usize>,
}

impl Polygon {
    fn finish(mut self, outlines: &mut OutlineList) -> Result<(), OutlineError> {
        if self.corners.len() > 1 && self.corners.first() == self.corners.last() {
            self.corners.pop();
        }
        if self.corners.len() < 3 {
            return Err(OutlineFault::Corners { count: self.corners.len() }.at(self.line));
        }
        let ends = self.corners.iter().cycle().skip(1);
        let sides = self.corners.iter().zip(ends).map(|(&start, &end)| Piece::segment(start, end));
        outlines.add(sides.collect(), self.line)
    }
}

/// What is between the cells of a row.
#[derive(Copy, Clone, Debug, PartialEq)]
enum Separator {
    Character(u8),
    /// Any number of blanks.
    Blanks,
}

/// The separator in the line `sep=;`, which spreadsheets write before all others.
fn stated_separator(line: &str) -> Option<Separator> {
    match line.as_bytes() {
        [b's' | b'S', b'e' | b'E', b'p' | b'P', b'=', separator @ (b',' | b';')] => {
            Some(Separator::Character(*separator))
        }
        _ => None,
    }
}

/// The separator in the first row of a file.
fn separator_of(row: &str) -> Separator {
    let separators = [b';', b'\t', b','];
    let found = separators.into_iter().find(|separator| row.contains(char::from(*separator)));
    found.map_or(Separator::Blanks, Separator::Character)
}

/// The cells of a line.
struct Row {
    cells: Vec<String>,
    /// True if a comma in a cell is the decimal point, as in many languages.
    has_decimal_commas: bool,
}

impl Row {
    fn of(line: &str, separator: Separator) -> Result<Self, OutlineFault> {
        if line.matches('"').count() % 2 == 1 {
            return Err(OutlineFault::Syntax { reason: "a quote is not closed in this line".to_owned() });
        }
        let Separator::Character(character) = separator else {
            let cells = line.split_whitespace().map(str::to_owned).collect();
            return Ok(Self { cells, has_decimal_commas: false });
        };
        // To build a reader takes a hundred times as long as to split a line.
        let cells = if line.contains(['"', '\r']) {
            quoted(line, character)?
        } else {
            line.split(char::from(character)).map(|cell| cell.trim().to_owned()).collect()
        };
        Ok(Self { cells: without_empty_end(cells), has_decimal_commas: character != b',' })
    }

    fn place(&self) -> Option<[f64; 2]> {
        let [x, y] = self.cells.as_slice() else { return None };
        Some([self.number(x)?, self.number(y)?])
    }

    fn number(&self, cell: &str) -> Option<f64> {
        // The quotes of a cell with blanks before them.
        let cell = cell.trim_matches('"').trim();
        cell.parse().ok().or_else(|| {
            let is_decimal = self.has_decimal_commas && !cell.contains('.') && cell.matches(',').count() == 1;
            if is_decimal { cell.replace(',', ".").parse().ok() } else { None }
        })
    }

    /// True if no cell begins like a number.
    fn is_header(&self) -> bool {
        let is_name = |cell: &String| {
            cell.starts_with(|letter: char| letter.is_alphabetic() || letter == '_') && self.number(cell).is_none()
        };
        self.cells.len() == 2 && self.cells.iter().all(is_name)
    }
}

/// The cells of a line with quotes.
fn quoted(line: &str, separator: u8) -> Result<Vec<String>, OutlineFault> {
    let mut record = StringRecord::new();
    ReaderBuilder::new()
        .delimiter(separator)
        .has_headers(false)
        .trim(Trim::All)
        .buffer_capacity(256)
        .from_reader(line.as_bytes())
        .read_record(&mut record)
        .map_err(|error| OutlineFault::Syntax { reason: error.to_string() })?;
    Ok(record.iter().map(str::to_owned).collect())
}

/// The cells without empty ones behind the second.
fn without_empty_end(mut cells: Vec<String>) -> Vec<String> {
    while cells.len() > 2 && cells.last().is_some_and(String::is_empty) {
        cells.pop();
    }
    cells
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]

    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn a_line_without_quotes_has_the_cells_that_the_crate_reads(
            line in "[-0-9.e]{1,6}([ \t]{0,2}[,;][ \t]{0,2}[-0-9.e\u{e9}]{0,6}){0,4}", separator in prop::sample::select(vec![b',', b';', b'\t']),
        ) {
            let row = Row::of(&line, Separator::Character(separator)).unwrap();
            prop_assert_eq!(row.cells, without_empty_end(quoted(&line, separator).unwrap()));
        }
    }
}
