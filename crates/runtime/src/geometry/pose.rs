//! Where a frame stands in the plane, and vectors.

use super::{Point2, Vector2};

/// The vector (1, 0) turned counter-clockwise by `angle` (rad).
///
/// ```
/// use vibrissa_runtime::geometry::{unit, Vector2};
/// assert!((unit(std::f64::consts::FRAC_PI_2) - Vector2::new(0.0, 1.0)).norm() < 1e-15);
/// ```
#[must_use]
pub fn unit(angle: f64) -> Vector2 {
    let (sin, cos) = angle.sin_cos();
    Vector2::new(cos, sin)
}

/// A vector turned counter-clockwise by `angle` (rad).
#[must_use]
pub fn rotate(vector: Vector2, angle: f64) -> Vector2 {
    let (sin, cos) = angle.sin_cos();
    Vector2::new(cos * vector.x - sin * vector.y, sin * vector.x + cos * vector.y)
}

/// A vector turned counter-clockwise by a quarter: for a direction of travel, the normal on its left.
#[must_use]
pub fn perpendicular(vector: Vector2) -> Vector2 {
    Vector2::new(-vector.y, vector.x)
}

/// The pose of a local frame (a body, an object) in the world.
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
    /// The frame's origin, in world coordinates (m).
    pub position: Point2,
    /// The direction of the frame's x axis, counter-clockwise from the world's (rad). It is not wrapped: it counts whole
    /// turns.
    pub heading: f64,
}

impl Pose {
    /// A pose of which nothing is known: every coordinate is not a number.
    pub const UNKNOWN: Self = Self { position: Point2::new(f64::NAN, f64::NAN), heading: f64::NAN };

    /// Whether every coordinate is a finite number.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        self.position.x.is_finite() && self.position.y.is_finite() && self.heading.is_finite()
    }

    /// World coordinates of a point given in this frame.
    #[must_use]
    pub fn point_to_world(&self, point: Point2) -> Point2 {
        self.position + self.vector_to_world(point.coords)
    }

    /// World components of a vector given in this frame.
    #[must_use]
    pub fn vector_to_world(&self, vector: Vector2) -> Vector2 {
        rotate(vector, self.heading)
    }

    /// Coordinates in this frame of a point given in the world.
    #[must_use]
    pub fn point_from_world(&self, point: Point2) -> Point2 {
        Point2::from(self.vector_from_world(point - self.position))
    }

    /// Components in this frame of a vector given in the world.
    #[must_use]
    pub fn vector_from_world(&self, vector: Vector2) -> Vector2 {
        rotate(vector, -self.heading)
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
