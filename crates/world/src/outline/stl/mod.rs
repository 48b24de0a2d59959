//! STL: the outlines of a mesh in a cutting plane.

mod binary;
mod text;
mod triangle;

use crate::geometry::{Piece, Point2};

use super::assemble::{LoosePiece, assemble};
use super::outline_list::{Outline, OutlineList};
use super::transform::Transform;
use super::{MAX_PIECES, OutlineError, OutlineFault, ReadOptions, TOLERANCE};
use triangle::Triangle;

/// The marks at the beginning of texts with two bytes for a letter.
const UTF_16: [[u8; 2]; 2] = [[0xFF, 0xFE], [0xFE, 0xFF]];

/// The largest number of triangle sides in the plane, before collinear ones are merged.
const MAX_SIDES: usize = 2 * MAX_PIECES;

/// Reads the outlines in the plane of one height. A solid that is closed there has its own outlines. The others are parts of one
/// surface and are joined.
pub(super) fn read(bytes: &[u8], options: &ReadOptions<'_>) -> Result<Vec<Outline>, OutlineError> {
    let unit = options.unit.ok_or(OutlineFault::NoUnit)?;
    let is_binary = binary::is_binary(bytes);
    if !is_binary && UTF_16.iter().any(|mark| bytes.starts_with(mark)) {
        let reason = "it is a text in UTF-16; save it as ASCII or UTF-8".to_owned();
        return Err(OutlineFault::Syntax { reason }.into());
    }
    let is_text = !is_binary && text::is_text(bytes);
    let solids = if is_text { text::read(bytes)? } else { vec![binary::read(bytes)?] };
    let mut cut = Cut {
        plane: Transform::scaled(unit),
        unit,
        height: options.height,
        extent: (f64::INFINITY, f64::NEG_INFINITY),
        count: 0,
    };
    let (mut loops, mut parts) = (Vec::new(), Vec::new());
    for solid in &solids {
        let sides = cut.sides(solid)?;
        match assemble(&sides) {
            Ok(closed) => loops.extend(closed),
            Err(_) => parts.extend(sides),
        }
    }
    if cut.count == 0 {
        return Err(match cut.extent {
            (low, high) if low <= high => {
                OutlineFault::Missed { height: cut.height, lowest: low + cut.height, highest: high + cut.height }
            }
            _ => OutlineFault::NoOutline,
        }
        .into());
    }
    loops.extend(assemble(&parts).map_err(|error| match error.fault {
        OutlineFault::Open { from, .. } => OutlineFault::NotWatertight { at: from }.into(),
        _ => error,
    })?);
    let mut outlines = OutlineList::default();
    for (pieces, _) in loops {
        outlines.add(straightened(&pieces), None)?;
    }
    outlines.into_outlines()
}

/// A cut by a plane.
struct Cut {
    plane: Transform,
    unit: f64,
    height: f64,
    /// The heights of the lowest and the highest corner above the plane (m).
    extent: (f64, f64),
    /// The number of triangle sides in the plane.
    count: usize,
}

/// A corner of a triangle: its position in the plane's coordinates, and its height above the plane (m).
struct Corner {
    place: Point2,
    above: f64,
}

impl Cut {
    /// The intersections of triangles with the plane.
    fn sides(&mut self, triangles: &[Triangle]) -> Result<Vec<LoosePiece>, OutlineError> {
        let mut sides = Vec::new();
        for Triangle { corners, line } in triangles {
            let [a, b, c] = corners.map(|corner| self.place(corner).map_err(|fault| fault.at(*line)));
            let corners = [a?, b?, c?];
            for corner in &corners {
                self.extent = (self.extent.0.min(corner.above), self.extent.1.max(corner.above));
            }
            sides.extend(side(&corners).map(|side| (side, None)));
            if self.count + sides.len() > MAX_SIDES {
                return Err(OutlineFault::TooLarge { what: "triangles in the plane", limit: MAX_SIDES }.at(*line));
            }
        }
        self.count += sides.len();
        Ok(sides)
    }

    fn place(&self, [x, y, z]: [f32; 3]) -> Result<Corner, OutlineFault> {
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
