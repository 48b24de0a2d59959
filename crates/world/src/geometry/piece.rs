//! The pieces of contours.

use std::f64::consts::PI;

use vibrissa_runtime::math;

use super::{Arc, BoundingBox, Point2, Pose, Segment, Vector2, perpendicular};

/// One piece of a contour, with a direction from its start to its end.
#[derive(Copy, Clone, Debug, PartialEq)]
pub enum Piece {
    /// A straight piece.
    Segment(Segment),
    /// A circular piece.
    Arc(Arc),
}

impl Piece {
    /// A segment between two points (m).
    #[must_use]
    pub fn segment(start: Point2, end: Point2) -> Self {
        Self::Segment(Segment { start, end })
    }

    /// A circular arc: centre and radius (m), direction from the centre to the start (rad), sweep angle (rad, positive
    /// counter-clockwise).
    #[must_use]
    pub fn arc(centre: Point2, radius: f64, start_angle: f64, sweep: f64) -> Self {
        Self::Arc(Arc { centre, radius, start_angle, sweep })
    }

    /// The arc from one point (m) to another with this sweep (rad, positive to the left, not 0, within ±2π).
    #[must_use]
    pub fn arc_between(start: Point2, end: Point2, sweep: f64) -> Self {
        let chord = end - start;
        // The centre is to the left of the middle of the chord for a left turn.
        let centre = nalgebra::center(&start, &end) + perpendicular(chord) * (0.5 / math::tan(0.5 * sweep));
        let outward = start - centre;
        Self::arc(centre, outward.norm(), math::atan2(outward.y, outward.x), sweep)
    }

    /// One or two pieces from the same start to another end (m), near its own: a segment, or arcs with the same sweep.
    #[must_use]
    pub(crate) fn ending_at(&self, end: Point2) -> Vec<Self> {
        match self {
            Self::Segment(segment) => vec![Self::segment(segment.start, end)],
            Self::Arc(arc) if arc.sweep.abs() <= PI => vec![Self::arc_between(arc.start(), end, arc.sweep)],
            // The ends of a nearly full circle are close together, and determine its centre only poorly.
            Self::Arc(arc) => {
                let half = Arc { sweep: 0.5 * arc.sweep, ..*arc };
                vec![Self::Arc(half), Self::arc_between(half.end(), end, half.sweep)]
            }
        }
    }

    /// Length (m).
    #[must_use]
    pub fn length(&self) -> f64 {
        match self {
            Self::Segment(segment) => segment.length(),
            Self::Arc(arc) => arc.length(),
        }
    }

    /// The start (m).
    #[must_use]
    pub fn start(&self) -> Point2 {
        match self {
            Self::Segment(segment) => segment.start,
            Self::Arc(arc) => arc.start(),
        }
    }

    /// The end (m).
    #[must_use]
    pub fn end(&self) -> Point2 {
        match self {
            Self::Segment(segment) => segment.end,
            Self::Arc(arc) => arc.end(),
        }
    }

    /// The point at arc length `s` (m) from the start, with `s` clamped to the piece.
    #[must_use]
    pub fn point_at(&self, s: f64) -> Point2 {
        match self {
            Self::Segment(segment) => segment.point_at(s),
            Self::Arc(arc) => arc.point_at(s),
        }
    }

    /// The tangent at arc length `s` (m), a unit vector in the direction of travel.
    #[must_use]
    pub fn tangent_at(&self, s: f64) -> Vector2 {
        match self {
            Self::Segment(segment) => segment.tangent(),
            Self::Arc(arc) => arc.tangent_at(s),
        }
    }

    /// Curvature (1/m), positive if the piece bends to the left.
    #[must_use]
    pub fn curvature(&self) -> f64 {
        match self {
            Self::Segment(_) => 0.0,
            Self::Arc(arc) => arc.sweep.signum() / arc.radius,
        }
    }

    /// Arc length (m) from the start to the point nearest to `point`. It is exactly 0 or `length()` at an end.
    #[must_use]
    pub fn nearest(&self, point: Point2) -> f64 {
        match self {
            Self::Segment(segment) => segment.nearest(point),
            Self::Arc(arc) => arc.nearest(point),
        }
    }

    /// Distance (m) of a point from the piece.
    #[must_use]
    pub fn distance(&self, point: Point2) -> f64 {
        match self {
            Self::Segment(segment) => segment.distance(point),
            Self::Arc(arc) => arc.distance(point),
        }
    }

    /// The same piece in the opposite direction.
    #[must_use]
    pub fn reversed(&self) -> Self {
        match self {
            Self::Segment(segment) => Self::Segment(segment.reversed()),
            Self::Arc(arc) => Self::Arc(arc.reversed()),
        }
    }

    /// Transforms the piece from the frame of `pose` to world coordinates.
    #[must_use]
    pub fn transformed(&self, pose: &Pose) -> Self {
        match self {
            Self::Segment(segment) => Self::Segment(segment.transformed(pose)),
            Self::Arc(arc) => Self::Arc(arc.transformed(pose)),
        }
    }

    /// The bounding box.
    #[must_use]
    pub fn bounding_box(&self) -> BoundingBox {
        match self {
            Self::Segment(segment) => segment.bounding_box(),
            Self::Arc(arc) => arc.bounding_box(),
        }
    }

    /// The signed area (m²) swept by the ray from `origin` to a point that moves along the piece, positive
    /// counter-clockwise. It is half the integral of x dy − y dx about `origin`.
    #[must_use]
    pub(crate) fn swept_area(&self, origin: Point2) -> f64 {
        let (start, end) = (self.start(), self.end());
        let triangle = 0.5 * (start - origin).perp(&(end - start));
        match self {
            Self::Segment(_) => triangle,
            // Relative to the chord of the arc, so that a flat arc with a distant centre loses no digits.
            Self::Arc(arc) => triangle + 0.5 * arc.radius * arc.radius * minus_sine(arc.sweep),
        }
    }
}

/// x − sin x, accurate also for small x.
fn minus_sine(x: f64) -> f64 {
    if x.abs() > 0.5 {
        return x - math::sin(x);
    }
    // The series of x − sin x in Horner's form. The first omitted term is below 1e-17 of the sum.
    let square = x * x;
    let tail = [272.0, 210.0, 156.0, 110.0, 72.0, 42.0, 20.0].iter().fold(1.0, |sum, n| 1.0 - square / n * sum);
    x * square / 6.0 * tail
}

impl From<Segment> for Piece {
    fn from(segment: Segment) -> Self {
        Self::Segment(segment)
    }
}

impl From<Arc> for Piece {
    fn from(arc: Arc) -> Self {
        Self::Arc(arc)
    }
}
