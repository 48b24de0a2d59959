//! Convex decomposition of concave outlines.

use i_triangle::float::triangulatable::Triangulatable;

use crate::geometry::{Contour, Point2};

use super::part::{Part, corners};
use super::parts_fault::PartsFault;

/// The largest distance (m) of a chord from its arc.
const SAGITTA: f64 = 5e-6;
/// The relative loss of area that is tolerated. It results from rounding coordinates to a grid.
const AREA_TOLERANCE: f64 = 1e-9;

/// Decomposes the interior of a closed contour into convex parts. A Delaunay triangulation is merged as long as the
/// parts remain convex.
pub(super) fn parts(contour: &Contour) -> Result<Vec<Part>, PartsFault> {
    let corners = corners(contour, SAGITTA)?;
    let outline: Vec<[f64; 2]> = corners.iter().map(|corner| [corner.x, corner.y]).collect();
    let polygons = outline.as_slice().triangulate_as::<i64>().into_delaunay().to_convex_polygons();
    let parts: Vec<Vec<Point2>> =
        polygons.into_iter().map(|part| part.into_iter().map(Point2::from).collect()).collect();
    let whole = area(&corners);
    let lost = whole - parts.iter().map(|part| area(part)).sum::<f64>();
    // Chords can intersect although their arcs do not. The parts then do not cover the outline.
    if lost.abs() > AREA_TOLERANCE * whole {
        return Err(PartsFault::Chords);
    }
    Ok(parts.into_iter().map(|outline| Part::Prism { outline }).collect())
}

/// The signed area (m²) of a polygon, positive counter-clockwise.
fn area(corners: &[Point2]) -> f64 {
    let Some(first) = corners.first() else { return 0.0 };
    corners.windows(2).map(|side| 0.5 * (side[0] - first).perp(&(side[1] - first))).sum()
}
