//! The map of a run against the exact geometry.

use std::fmt;

use vibrissa_runtime::map::{CellSpan, Map};
use vibrissa_runtime::math;
use vibrissa_world::geometry::{BoundingBox, Contour, ContourSet, Point2};

/// Depth (m) in an object up to which a free cell is within the accuracy of the map.
pub const WRONG_DEPTH: f64 = 2e-3;
/// Distance (m) from a position up to which unknown ground counts as near it.
const NEAR: f64 = 0.1;

/// What a map claims, and what it leaves open. Areas are in m².
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MapFigures {
    /// Area that is proved free.
    pub free: f64,
    /// Part of it that is more than [`WRONG_DEPTH`] inside of an object. Anything but 0 is an error of the map.
    pub wrong_free: f64,
    /// Area of the unknown ground beside free ground: what is left to be looked at, also where the policy gave up.
    pub unknown: f64,
    /// The position (m, world frame) that has the most unknown ground near it. `None` if nothing is unknown.
    pub unknown_near: Option<Point2>,
    /// True if the map is complete.
    pub is_complete: bool,
}

impl MapFigures {
    /// The figures of a map among surfaces.
    #[must_use]
    pub fn new(map: &Map, surfaces: &ContourSet) -> Self {
        let unknown: Vec<_> = map.unknown_blocks().collect();
        Self {
            free: map.free_area(),
            wrong_free: wrong_free_area(map, surfaces),
            unknown: unknown.len() as f64 * math::square(map.block_size()),
            unknown_near: densest(&unknown),
            is_complete: map.is_complete(),
        }
    }

    /// What the run leaves, with the share of the contour in reach that it traced (0 to 1).
    pub(crate) fn left(&self, coverage_in_reach: f64) -> impl fmt::Display {
        Left { figures: *self, coverage_in_reach }
    }
}

/// What a run with a map leaves, as a text.
struct Left {
    figures: MapFigures,
    coverage_in_reach: f64,
}

impl fmt::Display for Left {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let MapFigures { unknown, unknown_near, is_complete, .. } = self.figures;
        f.write_str(if is_complete { "the map is complete: " } else { "the map is not complete: " })?;
        write!(f, "{:.1} % of the contour in reach is traced, ", 100.0 * self.coverage_in_reach)?;
        match unknown_near {
            Some(Point2 { coords }) if unknown > 0.0 => {
                write!(
                    f,
                    "and {unknown:.3} m² beside free ground are unknown, most near ({:.2} m, {:.2} m)",
                    coords.x, coords.y
                )
            }
            _ => f.write_str("and nothing beside free ground is unknown"),
        }
    }
}

/// Area (m²) of the free cells whose centres are more than [`WRONG_DEPTH`] inside of an object.
fn wrong_free_area(map: &Map, surfaces: &ContourSet) -> f64 {
    let spans: Vec<_> = map.free_spans().collect();
    let cell = map.cell_size();
    let of_contour = |contour: &Contour| -> usize {
        let around = contour.bounding_box();
        spans.iter().map(|span| wrong_cells(contour, &around, span, cell)).sum()
    };
    let count: usize = surfaces.contours().filter(|contour| contour.is_closed()).map(of_contour).sum();
    count as f64 * cell * cell
}

/// Number of cells of a span whose centres are more than [`WRONG_DEPTH`] inside of a contour with this box `around` it.
fn wrong_cells(contour: &Contour, around: &BoundingBox, span: &CellSpan, cell: f64) -> usize {
    let y = 0.5 * (span.low.y + span.high.y);
    let (mut x, end) = (span.low.x + 0.5 * cell, span.high.x.min(around.max.x));
    if y < around.min.y || y > around.max.y {
        return 0;
    }
    x += ((around.min.x - x) / cell).floor().max(0.0) * cell;
    let mut count = 0;
    while x < end {
        let point = Point2::new(x, y);
        let distance = contour.distance(point);
        let depth = if contour.contains(point) { distance } else { -distance };
        // The depth changes by no more than the way, so that most centres need not be measured.
        x += if depth > WRONG_DEPTH {
            count += 1;
            cell
        } else {
            (((WRONG_DEPTH - depth) / cell).floor() + 1.0) * cell
        };
    }
    count
}

/// The position with the most others within [`NEAR`].
fn densest(positions: &[Point2]) -> Option<Point2> {
    let near = |own: &&Point2| positions.iter().filter(|other| (*other - **own).norm() <= NEAR).count();
    positions.iter().max_by_key(near).copied()
}
