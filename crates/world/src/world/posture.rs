//! The true positions of platform and whiskers.

use nalgebra::Point3;

use crate::geometry::{Point2, Pose};

/// The true positions of platform and whiskers at one time.
#[derive(Debug, Clone, PartialEq)]
pub struct Posture {
    /// The pose of the platform's centre of mass (world frame).
    pub body: Pose,
    /// For every whisker of the rig, points of its axis from the base to the tip (m, world frame). The third coordinate
    /// is the height above the plane of the bases. The axis is straight between two points.
    pub shafts: Vec<Vec<Point3<f64>>>,
}

/// A point of the plane at a height (m) above it.
#[must_use]
pub fn raised(point: Point2, height: f64) -> Point3<f64> {
    Point3::new(point.x, point.y, height)
}
