//! Convex objects and the gaps between them.

use std::f64::consts::{PI, TAU};

use super::layout::{circle, polygon};
use vibrissa_runtime::math;
use vibrissa_world::geometry::{Point2, Segment, Vector2, perpendicular, rotate, unit};

/// A convex object: all points within a radius of a polygon, which may be a line or a point.
#[derive(Debug, Clone)]
pub(super) struct Convex {
    /// The corners of the polygon (m), counter-clockwise.
    corners: Vec<Point2>,
    radius: f64,
}

impl Convex {
    pub(super) fn disk(centre: Point2, radius: f64) -> Self {
        Self { corners: vec![centre], radius }
    }

    pub(super) fn line(from: Point2, to: Point2) -> Self {
        Self { corners: vec![from, to], radius: 0.0 }
    }

    /// A box around the origin with this half diagonal (m). `aspect` is its width as a share of its length.
    pub(super) fn rectangle(half_diagonal: f64, aspect: f64, heading: f64) -> Self {
        let half = half_diagonal / math::hypot(1.0, aspect);
        let corner = |(x, y): (f64, f64)| Point2::from(rotate(Vector2::new(half * x, half * aspect * y), heading));
        Self { corners: [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(corner).to_vec(), radius: 0.0 }
    }

    /// A regular polygon around the origin in a circle of this radius (m).
    pub(super) fn regular(radius: f64, corners: u32, heading: f64) -> Self {
        let corner = |k| Point2::from(radius * unit(heading + TAU * f64::from(k) / f64::from(corners)));
        Self { corners: (0..corners).map(corner).collect(), radius: 0.0 }
    }

    pub(super) fn moved(&self, by: Vector2) -> Self {
        Self { corners: self.corners.iter().map(|corner| corner + by).collect(), radius: self.radius }
    }

    /// The smallest component (m) of its points along a direction.
    pub(super) fn least(&self, direction: Vector2) -> f64 {
        let along = self.corners.iter().map(|corner| direction.dot(&corner.coords));
        along.fold(f64::INFINITY, f64::min) - self.radius
    }

    /// The distance (m) from another object. Objects that overlap have none that is positive.
    pub(super) fn gap(&self, other: &Self) -> f64 {
        let is_apart = |one: &Self, other: &Self| {
            one.sides().any(|side| {
                let outwards = -perpendicular(side.tangent());
                other.corners.iter().all(|corner| outwards.dot(&(corner - side.start)) > 0.0)
            })
        };
        let has_sides = self.corners.len() > 2 || other.corners.len() > 2;
        if has_sides && !is_apart(self, other) && !is_apart(other, self) {
            return -self.radius - other.radius;
        }
        let nearest = |one: &Self, other: &Self| {
            let distances = one.sides().flat_map(|side| other.corners.iter().map(move |&corner| side.distance(corner)));
            distances.fold(f64::INFINITY, f64::min)
        };
        let cores = match (self.corners.as_slice(), other.corners.as_slice()) {
            ([one], [other]) => (one - other).norm(),
            _ => nearest(self, other).min(nearest(other, self)),
        };
        cores - self.radius - other.radius
    }

    /// The mean of its corners (m).
    pub(super) fn centre(&self) -> Point2 {
        let sum: Vector2 = self.corners.iter().map(|corner| corner.coords).sum();
        Point2::from(sum / self.corners.len() as f64)
    }

    /// The area (m²) of a disk or a polygon.
    pub(super) fn area(&self) -> f64 {
        let twice: f64 = self.sides().map(|side| side.start.coords.perp(&side.end.coords)).sum();
        0.5 * twice + PI * self.radius * self.radius
    }

    /// The length (m) of its outline.
    pub(super) fn length(&self) -> f64 {
        self.sides().map(|side| side.length()).sum::<f64>() + TAU * self.radius
    }

    /// This object in a frame with this rotation (rad), as YAML.
    pub(super) fn text(&self, heading: f64) -> String {
        let turned = |corner: &Point2| Point2::from(rotate(corner.coords, heading));
        match self.corners.as_slice() {
            [centre] => circle(turned(centre), self.radius),
            corners => polygon(&corners.iter().map(turned).collect::<Vec<_>>()),
        }
    }

    /// The sides of the polygon. A point has none, and a line has it twice, once in each direction.
    fn sides(&self) -> impl Iterator<Item = Segment> {
        let count = if self.corners.len() > 1 { self.corners.len() } else { 0 };
        (0..count).map(move |k| Segment { start: self.corners[k], end: self.corners[(k + 1) % count] })
    }
}
