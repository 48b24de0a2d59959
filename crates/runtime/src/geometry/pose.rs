//! Poses in the plane, and rotations of vectors.

use super::{Point2, Vector2};
use crate::math;

/// The unit vector with the direction `angle` (rad, counter-clockwise from x).
///
/// ```
/// use vibrissa_runtime::geometry::{unit, Vector2};
/// assert!((unit(std::f64::consts::FRAC_PI_2) - Vector2::new(0.0, 1.0)).norm() < 1e-15);
/// ```
#[must_use]
pub fn unit(angle: f64) -> Vector2 {
    let (sin, cos) = math::sin_cos(angle);
    Vector2::new(cos, sin)
}

/// Rotates a vector counter-clockwise by `angle` (rad).
#[must_use]
pub fn rotate(vector: Vector2, angle: f64) -> Vector2 {
    let (sin, cos) = math::sin_cos(angle);
    Vector2::new(cos * vector.x - sin * vector.y, sin * vector.x + cos * vector.y)
}

/// Rotates a vector counter-clockwise by 90°. For a direction of travel this is the normal on its left.
#[must_use]
pub fn perpendicular(vector: Vector2) -> Vector2 {
    Vector2::new(-vector.y, vector.x)
}

/// The pose of a local frame (of a body or an object) in the world frame.
///
/// ```
/// use std::f64::consts::FRAC_PI_2;
/// use vibrissa_runtime::geometry::{Point2, Pose};
/// let body = Pose { position: Point2::new(1.0, 2.0), heading: FRAC_PI_2 };
/// let nose_world = body.point_to_world(Point2::new(0.1, 0.0));
/// assert!((nose_world - Point2::new(1.0, 2.1)).norm() < 1e-15);
/// ```
#[derive(Copy, Clone, Debug, PartialEq, Default)]
pub struct Pose {
    /// Origin of the frame in the world frame (m).
    pub position: Point2,
    /// Direction of the frame's x axis, counter-clockwise from that of the world (rad). It is not wrapped, so it counts
    /// whole rotations.
    pub heading: f64,
}

impl Pose {
    /// An unknown pose, with NaN in every coordinate.
    pub const UNKNOWN: Self = Self { position: Point2::new(f64::NAN, f64::NAN), heading: f64::NAN };

    /// True if every coordinate is finite.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        self.position.x.is_finite() && self.position.y.is_finite() && self.heading.is_finite()
    }

    /// Transforms a point of this frame to the world frame.
    #[must_use]
    pub fn point_to_world(&self, point: Point2) -> Point2 {
        self.position + self.vector_to_world(point.coords)
    }

    /// Transforms a vector of this frame to the world frame.
    #[must_use]
    pub fn vector_to_world(&self, vector: Vector2) -> Vector2 {
        rotate(vector, self.heading)
    }

    /// Transforms a point of the world frame to this frame.
    #[must_use]
    pub fn point_from_world(&self, point: Point2) -> Point2 {
        Point2::from(self.vector_from_world(point - self.position))
    }

    /// Transforms a vector of the world frame to this frame.
    #[must_use]
    pub fn vector_from_world(&self, vector: Vector2) -> Vector2 {
        rotate(vector, -self.heading)
    }
}

/// A frame with the sine and cosine of its heading, for many points.
#[derive(Copy, Clone, Debug)]
pub(crate) struct Frame {
    pub(crate) pose: Pose,
    pub(crate) sine: f64,
    pub(crate) cosine: f64,
}

impl Frame {
    pub(crate) fn new(pose: Pose) -> Self {
        let (sine, cosine) = math::sin_cos(pose.heading);
        Self { pose, sine, cosine }
    }

    /// Transforms a point of this frame to the world frame, as [`Pose::point_to_world`].
    pub(crate) fn point_to_world(&self, point: Point2) -> Point2 {
        let Self { pose, sine, cosine } = self;
        pose.position + Vector2::new(cosine * point.x - sine * point.y, sine * point.x + cosine * point.y)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn going_to_the_world_and_back_changes_nothing() {
        let pose = Pose { position: Point2::new(-0.4, 1.3), heading: 7.7 };
        let point = Point2::new(0.2, -0.9);
        assert!((pose.point_from_world(pose.point_to_world(point)) - point).norm() < 1e-15);
    }

    #[test]
    fn the_perpendicular_is_on_the_left() {
        let forward = unit(0.7);
        assert!((perpendicular(forward) - rotate(forward, std::f64::consts::FRAC_PI_2)).norm() < 1e-15);
    }
}
