//! Coordinate transforms of a drawing.

use crate::geometry::{Point2, Vector2};

use super::OutlineFault;

/// The largest coordinate (m), equal to the limit of scenarios.
const REACH: f64 = 100.0;

/// An affine map of a file's coordinates to metres, y up.
#[derive(Copy, Clone, Debug, PartialEq)]
pub(super) struct Transform {
    /// The images of the file's axes and of its origin (m).
    pub(super) x_axis: Vector2,
    pub(super) y_axis: Vector2,
    pub(super) origin: Vector2,
}

impl Transform {
    /// Creates a scaling with this unit length (m).
    pub(super) fn scaled(unit: f64) -> Self {
        Self { x_axis: Vector2::new(unit, 0.0), y_axis: Vector2::new(0.0, unit), origin: Vector2::zeros() }
    }

    /// Composes this transform with an inner one, which is given by the images of its axes and of its origin.
    pub(super) fn inner(&self, x_axis: [f64; 2], y_axis: [f64; 2], origin: [f64; 2]) -> Self {
        Self {
            x_axis: self.direction(x_axis),
            y_axis: self.direction(y_axis),
            origin: self.origin + self.direction(origin),
        }
    }

    /// True if circles remain circles: the images of the axes are perpendicular and of equal length.
    pub(super) fn keeps_circles(&self) -> bool {
        const ROUND: f64 = 1e-9;
        let (x, y) = (self.x_axis, self.y_axis);
        let size = x.norm_squared();
        x.dot(&y).abs() <= ROUND * size && (y.norm_squared() - size).abs() <= ROUND * size
    }

    pub(super) fn direction(&self, [x, y]: [f64; 2]) -> Vector2 {
        self.x_axis * x + self.y_axis * y
    }

    pub(super) fn point(&self, place: [f64; 2]) -> Result<Point2, OutlineFault> {
        let point = Point2::from(self.origin + self.direction(place));
        if is_near(point) { Ok(point) } else { Err(OutlineFault::FarOff) }
    }
}

/// True if the coordinates are numbers within the limit.
pub(super) fn is_near(point: Point2) -> bool {
    point.coords.iter().all(|coordinate| coordinate.abs() <= REACH)
}
