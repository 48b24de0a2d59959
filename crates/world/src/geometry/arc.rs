//! Circular arcs.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use vibrissa_runtime::math;

use super::{BoundingBox, Point2, Pose, Vector2, perpendicular, unit};

/// The angle (rad, approximately) next to a spoke within which rounding may decide on which side of it a point is.
const SIDE_SLACK: f64 = 1e-9;

/// A circular arc of a contour.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Arc {
    /// Centre of the circle (m).
    pub centre: Point2,
    /// Radius of the circle (m), positive.
    pub radius: f64,
    /// Direction from the centre to the start (rad).
    pub start_angle: f64,
    /// Sweep angle (rad), positive counter-clockwise. A full circle is ±2π.
    pub sweep: f64,
}

impl Arc {
    /// Length (m).
    #[must_use]
    pub fn length(&self) -> f64 {
        self.radius * self.sweep.abs()
    }

    /// The start (m).
    #[must_use]
    pub fn start(&self) -> Point2 {
        self.at_angle(self.start_angle)
    }

    /// The end (m).
    #[must_use]
    pub fn end(&self) -> Point2 {
        self.at_angle(self.start_angle + self.sweep)
    }

    /// The point at arc length `s` (m) from the start, with `s` clamped to the arc.
    #[must_use]
    pub fn point_at(&self, s: f64) -> Point2 {
        self.at_angle(self.angle_at(s))
    }

    /// The tangent at arc length `s` (m), a unit vector in the direction of travel.
    #[must_use]
    pub fn tangent_at(&self, s: f64) -> Vector2 {
        perpendicular(unit(self.angle_at(s))) * self.sweep.signum()
    }

    /// Arc length (m) from the start to the point nearest to `point`. It is exactly 0 or `length()` at an end.
    #[must_use]
    pub fn nearest(&self, point: Point2) -> f64 {
        let travelled = self.angle_travelled(point - self.centre);
        if travelled < self.sweep.abs() {
            self.radius * travelled
        } else if (point - self.start()).norm_squared() <= (point - self.end()).norm_squared() {
            0.0
        } else {
            self.length()
        }
    }

    /// Distance (m) of a point from the arc.
    #[must_use]
    pub fn distance(&self, point: Point2) -> f64 {
        self.distance_by(self.spokes(), point)
    }

    /// The same, with precomputed [spokes](Self::spokes).
    pub(super) fn distance_by(&self, spokes: [Vector2; 2], point: Point2) -> f64 {
        let outward = point - self.centre;
        if self.is_beside(spokes, outward) {
            (outward.norm() - self.radius).abs()
        } else {
            let [to_start, to_end] = spokes.map(|spoke| (point - (self.centre + self.radius * spoke)).norm());
            to_start.min(to_end)
        }
    }

    /// The directions from the centre to the start and to the end, unit vectors.
    pub(super) fn spokes(&self) -> [Vector2; 2] {
        [unit(self.start_angle), unit(self.start_angle + self.sweep)]
    }

    /// True if a ray from the centre intersects the arc. The test uses the sides of the spokes, and the angle next to
    /// them.
    fn is_beside(&self, [start, end]: [Vector2; 2], outward: Vector2) -> bool {
        let (after_start, before_end) = (start.perp(&outward), outward.perp(&end));
        if after_start.abs().min(before_end.abs()) > SIDE_SLACK * (outward.x.abs() + outward.y.abs()) {
            let is_after_start = after_start * self.sweep > 0.0;
            let is_before_end = before_end * self.sweep > 0.0;
            if self.sweep.abs() <= PI { is_after_start && is_before_end } else { is_after_start || is_before_end }
        } else {
            self.angle_travelled(outward) < self.sweep.abs()
        }
    }

    /// The same arc in the opposite direction.
    #[must_use]
    pub fn reversed(&self) -> Self {
        Self { start_angle: self.start_angle + self.sweep, sweep: -self.sweep, ..*self }
    }

    /// Transforms the arc from the frame of `pose` to world coordinates.
    #[must_use]
    pub fn transformed(&self, pose: &Pose) -> Self {
        Self { centre: pose.point_to_world(self.centre), start_angle: self.start_angle + pose.heading, ..*self }
    }

    /// The bounding box.
    #[must_use]
    pub fn bounding_box(&self) -> BoundingBox {
        let mut bounds = BoundingBox::around(self.start(), self.end());
        for quarter in 0..4_u8 {
            let extreme = self.at_angle(f64::from(quarter) * FRAC_PI_2);
            if self.angle_travelled(extreme - self.centre) < self.sweep.abs() {
                bounds = bounds.union(&BoundingBox::around(extreme, extreme));
            }
        }
        bounds
    }

    fn at_angle(&self, angle: f64) -> Point2 {
        self.centre + self.radius * unit(angle)
    }

    fn angle_at(&self, s: f64) -> f64 {
        self.start_angle + (s / self.radius).clamp(0.0, self.sweep.abs()) * self.sweep.signum()
    }

    /// The angle in [0, 2π) from the start to a ray from the centre, in the direction of travel.
    fn angle_travelled(&self, outward: Vector2) -> f64 {
        let start = unit(self.start_angle);
        // The angle between two vectors is accurate near the start. A difference of two angles is not.
        let from_start = math::atan2(start.perp(&outward), start.dot(&outward)) * self.sweep.signum();
        if from_start < 0.0 { (from_start + TAU).min(TAU.next_down()) } else { from_start }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    const QUARTER: Arc = Arc { centre: Point2::new(1.0, 0.0), radius: 2.0, start_angle: 0.0, sweep: FRAC_PI_2 };

    #[test]
    fn an_arc_beyond_its_sweep_is_nearest_at_an_end() {
        assert!(QUARTER.nearest(Point2::new(4.0, -1.0)).abs() < f64::EPSILON);
        assert!((QUARTER.nearest(Point2::new(-1.0, 5.0)) - PI).abs() < 1e-15);
        assert!((QUARTER.distance(Point2::new(3.0, -1.0)) - 1.0).abs() < 1e-15);
    }

    #[test]
    fn the_box_reaches_past_the_ends_where_the_arc_does() {
        let over_the_top = Arc { start_angle: 0.25 * PI, sweep: FRAC_PI_2, ..QUARTER };
        assert!((over_the_top.bounding_box().max.y - 2.0).abs() < 1e-15);
        assert!((over_the_top.bounding_box().max.x - (1.0 + 2.0_f64.sqrt())).abs() < 1e-15);
    }

    #[test]
    fn travelling_back_visits_the_same_points() {
        for k in 0..=10 {
            let s = f64::from(k) * 0.1 * QUARTER.length();
            let back = QUARTER.reversed();
            assert!((back.point_at(QUARTER.length() - s) - QUARTER.point_at(s)).norm() < 1e-15);
            assert!((back.tangent_at(QUARTER.length() - s) + QUARTER.tangent_at(s)).norm() < 1e-15);
        }
    }

    proptest! {
        #[test]
        fn the_sides_of_the_spokes_tell_what_the_angle_tells(
            start_angle in -7.0..7.0_f64, sweep in -TAU..TAU, direction in -PI..PI, near in -1e-8..1e-8_f64, kind in 0..3,
        ) {
            let arc = Arc { start_angle, sweep, ..QUARTER };
            let angle = match kind { 0 => direction, 1 => start_angle + near, _ => start_angle + sweep + near };
            let outward = 1.7 * unit(angle);
            prop_assert_eq!(arc.is_beside(arc.spokes(), outward), arc.angle_travelled(outward) < sweep.abs());
        }
    }
}
