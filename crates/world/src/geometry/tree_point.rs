//! Points in trees of bounding boxes.

use super::Point2;

/// A point (m, world frame) in a tree of bounding boxes.
///
/// It is a pair, because the tree's functions for arrays are not inlined, so that a search takes twice as long.
pub type TreePoint = (f64, f64);

/// The same point for a tree.
#[must_use]
pub fn tree_point(point: Point2) -> TreePoint {
    (point.x, point.y)
}

/// The point of a tree in the plane.
#[must_use]
pub fn plane_point((x, y): TreePoint) -> Point2 {
    Point2::new(x, y)
}
