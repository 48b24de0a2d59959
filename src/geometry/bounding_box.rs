//! Boxes along the axes.

use super::Point2;

/// The smallest box with sides along the axes that holds something.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct BoundingBox {
    /// The corner with the smallest coordinates (m).
    pub min: Point2,
    /// The corner with the largest coordinates (m).
    pub max: Point2,
}

impl BoundingBox {
    /// The box around two points.
    #[must_use]
    pub fn around(a: Point2, b: Point2) -> Self {
        Self { min: a.inf(&b), max: a.sup(&b) }
    }

    /// The smallest box that holds both boxes.
    #[must_use]
    pub fn union(&self, other: &Self) -> Self {
        Self { min: self.min.inf(&other.min), max: self.max.sup(&other.max) }
    }

    /// Distance (m) of a point from the box; 0 inside.
    #[must_use]
    pub fn distance(&self, point: Point2) -> f64 {
        (point - point.sup(&self.min).inf(&self.max)).norm()
    }

    /// Whether the boxes share a point.
    #[must_use]
    pub fn meets(&self, other: &Self) -> bool {
        self.min <= other.max && other.min <= self.max
    }
}
