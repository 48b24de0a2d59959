//! STL: the outlines of a mesh in a cutting plane.

use std::io::{Cursor, ErrorKind};

use stl_io::{Vector, Vertex, create_stl_reader};

use crate::geometry::{Piece, Point2};

use super::assemble::{LoosePiece, assemble};
use super::outline_list::{Outline, OutlineList};
use super::transform::Transform;
use super::{MAX_PIECES, OutlineError, OutlineFault, ReadOptions, TOLERANCE};

/// The number of bytes before the triangles of a binary file, and of a triangle.
const HEADER: usize = 84;
const TRIANGLE: usize = 50;

/// The largest number of triangle sides in the plane, before collinear ones are merged.
const MAX_SIDES: usize = 2 * MAX_PIECES;

/// Reads the outlines in the plane of one height.
pub(super) fn read(bytes: &[u8], options: &ReadOptions<'_>) -> Result<Vec<Outline>, OutlineError> {
    let unit = options.unit.ok_or(OutlineFault::NoUnit)?;
    let mut sides: Vec<LoosePiece> = Vec::new();
    let mut extent = (f64::INFINITY, f64::NEG_INFINITY);
    let cut = Cut { plane: Transform::scaled(unit), unit, height: options.height };
    let mut bytes = Cursor::new(with_type_marker(bytes));
    for triangle in create_stl_reader(&mut bytes).map_err(|error| refusal(&error))? {
        let corners = triangle.map_err(|error| refusal(&error))?.vertices.map(|vertex| cut.place(vertex));
        let [a, b, c] = corners;
        let corners = [a?, b?, c?];
        for corner in &corners {
            extent = (extent.0.min(corner.above), extent.1.max(corner.above));
        }
        sides.extend(side(&corners).map(|side| (side, None)));
        if sides.len() > MAX_SIDES {
            return Err(OutlineFault::TooLarge { what: "triangles in the plane", limit: MAX_SIDES }.into());
        }
    }
    if sides.is_empty() {
        return Err(match extent {
            (low, high) if low <= high => {
                OutlineFault::Missed { height: cut.height, lowest: low + cut.height, highest: high + cut.height }
            }
            _ => OutlineFault::NoOutline,
        }
        .into());
    }
    let loops = assemble(&sides).map_err(|error| match error.fault {
        OutlineFault::Open { from, .. } => OutlineFault::NotWatertight { at: from }.into(),
        _ => error,
    })?;
    let mut outlines = OutlineList::default();
    for (pieces, _) in loops {
        outlines.add(straightened(&pieces), None)?;
    }
    outlines.into_outlines()
}

/// Returns the bytes in a form in which the reader recognises the file type, by `solid ` at the beginning. A text file
/// may lack the blank, and a binary file may begin so too. The length of the file decides.
fn with_type_marker(bytes: &[u8]) -> Vec<u8> {
    let count = bytes.first_chunk::<HEADER>().map(|&[.., a, b, c, d]| u32::from_le_bytes([a, b, c, d]));
    let length = count.and_then(|count| usize::try_from(count).ok()?.checked_mul(TRIANGLE)?.checked_add(HEADER));
    let is_binary = length == Some(bytes.len());
    let mut prepared = bytes.to_vec();
    if is_binary {
        prepared[..HEADER - 4].fill(0);
    } else if bytes.starts_with(b"solid") && bytes.get(5).is_some_and(|&next| next != b' ') {
        prepared.insert(5, b' ');
    }
    prepared
}

/// A cut by a plane.
struct Cut {
    plane: Transform,
    unit: f64,
    height: f64,
}

/// A corner of a triangle: its position in the plane's coordinates, and its height above the plane (m).
struct Corner {
    place: Point2,
    above: f64,
}

impl Cut {
    fn place(&self, Vector([x, y, z]): Vertex) -> Result<Corner, OutlineFault> {
        let above = f64::from(z) * self.unit - self.height;
        let place = self.plane.point([x.into(), y.into()])?;
        if above.abs() <= 100.0 { Ok(Corner { place, above }) } else { Err(OutlineFault::FarOff) }
    }
}

/// The intersection of a triangle with the plane. A corner in the plane counts as above it, for all triangles alike, so
/// that a mesh without gaps has no open outline.
fn side(corners: &[Corner; 3]) -> Option<Piece> {
    let mut crossings = [(0, 1), (1, 2), (2, 0)].into_iter().filter_map(|(from, to)| {
        let (from, to) = (&corners[from], &corners[to]);
        // Computed from below, so that both triangles at an edge give the same point.
        let (low, high) = if from.above < 0.0 { (from, to) } else { (to, from) };
        let crosses = low.above < 0.0 && high.above >= 0.0;
        crosses.then(|| low.place + (high.place - low.place) * (low.above / (low.above - high.above)))
    });
    let (start, end) = (crossings.next()?, crossings.next()?);
    // The triangle touches the plane with a corner only.
    (start != end).then(|| Piece::segment(start, end))
}

/// The corners of a closed outline without those that are collinear within the tolerance.
fn straightened(sides: &[Piece]) -> Vec<Piece> {
    let corners: Vec<Point2> = sides.iter().map(Piece::start).collect();
    // The leftmost corner, and of these the lowest, is never collinear with its neighbours.
    let first = (0..corners.len()).min_by(|&a, &b| {
        let key = |index: usize| [corners[index].x, corners[index].y];
        key(a).partial_cmp(&key(b)).unwrap_or(std::cmp::Ordering::Equal)
    });
    let around: Vec<Point2> =
        corners.iter().cycle().skip(first.unwrap_or(0)).take(corners.len() + 1).copied().collect();
    let mut kept = Vec::new();
    let mut start = 0;
    while start + 1 < around.len() {
        let reach = (start + 2..around.len()).take_while(|&end| is_straight(&around[start..=end])).last();
        let end = reach.unwrap_or(start + 1);
        kept.push(Piece::segment(around[start], around[end]));
        start = end;
    }
    kept
}

/// True if the points lie on a line in ascending order.
fn is_straight(places: &[Point2]) -> bool {
    let [first, between @ .., last] = places else { return true };
    let Some(along) = (last - first).try_normalize(TOLERANCE) else { return false };
    let length = (last - first).norm();
    between.iter().all(|place| {
        let offset = place - first;
        along.perp(&offset).abs() <= 0.5 * TOLERANCE && (0.0..=length).contains(&along.dot(&offset))
    })
}

fn refusal(error: &std::io::Error) -> OutlineError {
    let reason = match error.kind() {
        ErrorKind::UnexpectedEof => "it ends in the middle of a triangle".to_owned(),
        _ => format!("it is no STL: {error}"),
    };
    OutlineFault::Syntax { reason }.into()
}
