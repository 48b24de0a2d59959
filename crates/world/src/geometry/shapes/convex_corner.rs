//! A convex corner with the rest of an object behind it.

use std::f64::consts::PI;

use vibrissa_runtime::math;

use crate::geometry::Vector2;

/// The vertices of a symmetric object with a convex corner, counter-clockwise and relative to this corner, which points
/// along x. The outline turns by `angle` (rad) at the corner. Two sides of the length `side` (m) meet there, and two
/// parallel sides of the length `back` (m) follow.
///
/// ```
/// use std::f64::consts::FRAC_PI_2;
/// use vibrissa_world::geometry::{Point2, convex_corner, polygon};
/// let vertices = convex_corner(FRAC_PI_2, 0.1, 0.2).map(Point2::from);
/// let outline = polygon(&vertices)?;
/// assert!((outline.length() - (0.6 + 0.1 * 2_f64.sqrt())).abs() < 1e-12);
/// # Ok::<(), vibrissa_world::geometry::ShapeError>(())
/// ```
#[must_use]
pub fn convex_corner(angle: f64, side: f64, back: f64) -> [Vector2; 5] {
    let half = 0.5 * (PI - angle);
    let (width, depth) = (side * math::sin(half), side * math::cos(half));
    let (left, right) = (Vector2::new(-depth, width), Vector2::new(-depth, -width));
    let behind = Vector2::new(-back, 0.0);
    [Vector2::zeros(), left, left + behind, right + behind, right]
}
