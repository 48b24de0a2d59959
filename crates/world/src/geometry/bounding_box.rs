//! Axis-aligned bounding boxes.

use super::Point2;

/// An axis-aligned bounding box.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct BoundingBox {
    /// The corner with the smallest coordinates (m).
    pub min: Point2,
    /// The corner with the largest coordinates (m).
    pub max: Point2,
}

impl BoundingBox {
    /// The bounding box of two points.
    #[must_use]
    pub fn around(a: Point2, b: Point2) -> Self {
        Self { min: a.inf(&b), max: a.sup(&b) }
    }

    /// The bounding box of both boxes.
    #[must_use]
    pub fn union(&self, other: &Self) -> Self {
        Self { min: self.min.inf(&other.min), max: self.max.sup(&other.max) }
    }

    /// Distance (m) of a point from the box, 0 inside.
    #[must_use]
    pub fn distance(&self, point: Point2) -> f64 {
        (point - point.sup(&self.min).inf(&self.max)).norm()
    }

    /// True if the boxes have a common point.
    #[must_use]
    pub fn meets(&self, other: &Self) -> bool {
        self.min <= other.max && other.min <= self.max
    }
}
