//! Line segments.

use super::{BoundingBox, Point2, Pose, Vector2};

/// A straight piece of a contour.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Segment {
    /// The start (m).
    pub start: Point2,
    /// The end (m).
    pub end: Point2,
}

impl Segment {
    /// Length (m).
    #[must_use]
    pub fn length(&self) -> f64 {
        (self.end - self.start).norm()
    }

    /// The direction of travel, a unit vector.
    #[must_use]
    pub fn tangent(&self) -> Vector2 {
        (self.end - self.start).normalize()
    }

    /// The point at arc length `s` (m) from the start, with `s` clamped to the segment.
    #[must_use]
    pub fn point_at(&self, s: f64) -> Point2 {
        let length = self.length();
        // Both ends are exact, so that neighbours meet without a gap.
        if s <= 0.0 {
            self.start
        } else if s >= length {
            self.end
        } else {
            self.start + (self.end - self.start) * (s / length)
        }
    }

    /// Arc length (m) from the start to the point nearest to `point`. It is exactly 0 or `length()` at an end.
    #[must_use]
    pub fn nearest(&self, point: Point2) -> f64 {
        (point - self.start).dot(&self.tangent()).clamp(0.0, self.length())
    }

    /// Distance (m) of a point from the segment.
    #[must_use]
    pub fn distance(&self, point: Point2) -> f64 {
        let along = (point - self.start).dot(&self.tangent());
        if along <= 0.0 {
            (point - self.start).norm()
        } else if along >= self.length() {
            (point - self.end).norm()
        } else {
            (point - self.start).perp(&self.tangent()).abs()
        }
    }

    /// The same segment in the opposite direction.
    #[must_use]
    pub fn reversed(&self) -> Self {
        Self { start: self.end, end: self.start }
    }

    /// Transforms the segment from the frame of `pose` to world coordinates.
    #[must_use]
    pub fn transformed(&self, pose: &Pose) -> Self {
        Self { start: pose.point_to_world(self.start), end: pose.point_to_world(self.end) }
    }

    /// The bounding box.
    #[must_use]
    pub fn bounding_box(&self) -> BoundingBox {
        BoundingBox::around(self.start, self.end)
    }
}
