//! A bar with one bend.

use crate::geometry::{Vector2, perpendicular, unit};

/// The vertices of a bent bar relative to its inner corner. The first side, of the length `first` (m), ends at the
/// corner and is along x. There the outline turns by `angle` (rad), and the second side has the length `second` (m).
///
/// The bar has this `thickness` (m). It is to the right of the sides if the angle is positive, else to their left. So
/// the corner is concave.
#[must_use]
pub fn concave_corner(angle: f64, first: f64, second: f64, thickness: f64) -> [Vector2; 6] {
    let hand = if angle < 0.0 { -1.0 } else { 1.0 };
    let (into, out) = (unit(0.0), unit(angle));
    let across = |along: Vector2| -hand * thickness * perpendicular(along);
    // The corner of the two outer sides is on the bisector of their normals.
    let outer = (across(into) + across(out)) / (1.0 + into.dot(&out));
    [Vector2::zeros(), second * out, second * out + across(out), outer, across(into) - first * into, -first * into]
}
