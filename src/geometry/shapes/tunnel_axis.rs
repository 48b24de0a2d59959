//! The line in the middle of a tunnel.

use crate::geometry::{Contour, Point2, Vector2, perpendicular};

/// Newton's steps towards the axis. Each squares what is left of the way, of millimetres at a decimetre from either wall.
const STEPS: usize = 6;

/// The axis of a tunnel: the line as far from its left wall as from its right one (the thesis's section 5.3).
///
/// Where both walls are parallels of the line that they are drawn along, it is that line; around the corners of straight runs
/// it is a little nearer to the inner corner. Walls at a distance along a radius are not parallel.
#[derive(Clone, Debug)]
pub struct TunnelAxis {
    line: Contour,
    left: Contour,
    right: Contour,
}

impl TunnelAxis {
    /// The axis between the sides of two walls that face the tunnel. The `line` that they are drawn along tells where the
    /// tunnel begins and ends.
    #[must_use]
    pub fn new(line: Contour, left: Contour, right: Contour) -> Self {
        Self { line, left, right }
    }

    /// The line that the walls are drawn along; closed in a round tunnel.
    #[must_use]
    pub fn line(&self) -> &Contour {
        &self.line
    }

    /// The parallel of the line along which the left wall faces the tunnel, without openings.
    #[must_use]
    pub fn left(&self) -> &Contour {
        &self.left
    }

    /// The same of the right wall.
    #[must_use]
    pub fn right(&self) -> &Contour {
        &self.right
    }

    /// The arc length (m) of the [line](Self::line) beside a point between the walls; `None` for a point beyond a wall, before the
    /// beginning of the tunnel or beyond its end.
    ///
    /// ```
    /// use vibrissa::geometry::{Contour, Piece, Point2, TunnelAxis};
    /// let up = |x| Contour::open(vec![Piece::segment(Point2::new(x, 0.0), Point2::new(x, 1.0))]);
    /// let axis = TunnelAxis::new(up(0.0)?, up(-0.12)?, up(0.1)?);
    /// assert_eq!(axis.arc_length_between(Point2::new(0.09, 0.5)), Some(0.5));
    /// assert_eq!(axis.arc_length_between(Point2::new(0.11, 0.5)), None);
    /// assert_eq!(axis.arc_length_between(Point2::new(0.0, 1.5)), None);
    /// # Ok::<(), vibrissa::geometry::ContourError>(())
    /// ```
    #[must_use]
    pub fn arc_length_between(&self, point: Point2) -> Option<f64> {
        let left_of = |wall: &Contour| {
            let nearest = wall.nearest(point);
            perpendicular(wall.tangent_at(nearest.arc_length)).dot(&(point - nearest.point))
        };
        let is_between = left_of(&self.left) < 0.0 && left_of(&self.right) > 0.0;
        self.arc_length_beside(point).filter(|_| is_between)
    }

    /// How far (m) a point is from the axis, never negative; `None` before the beginning of the tunnel and beyond its end.
    ///
    /// ```
    /// use vibrissa::geometry::{Contour, Piece, Point2, TunnelAxis};
    /// let up = |x| Contour::open(vec![Piece::segment(Point2::new(x, 0.0), Point2::new(x, 1.0))]);
    /// let axis = TunnelAxis::new(up(0.0)?, up(-0.12)?, up(0.1)?);
    /// assert!((axis.distance(Point2::new(0.0, 0.5)).unwrap() - 0.01).abs() < 1e-12);
    /// assert_eq!(axis.distance(Point2::new(0.0, 1.5)), None);
    /// # Ok::<(), vibrissa::geometry::ContourError>(())
    /// ```
    #[must_use]
    pub fn distance(&self, point: Point2) -> Option<f64> {
        self.arc_length_beside(point).map(|_| (self.foot(point) - point).norm())
    }

    /// The arc length (m) of the line beside a point; `None` before the beginning of the tunnel and beyond its end.
    fn arc_length_beside(&self, point: Point2) -> Option<f64> {
        let along = self.line.nearest(point).arc_length;
        let is_inside = self.line.is_closed() || (along > 0.0 && along < self.line.length());
        is_inside.then_some(along)
    }

    /// The point of the axis that the difference of the distances from both walls leads to: the nearest one, but for the bend
    /// of the axis within the distance itself.
    fn foot(&self, point: Point2) -> Point2 {
        let mut foot = point;
        for _ in 0..STEPS {
            let (left, right) = (self.left.nearest(foot), self.right.nearest(foot));
            let apart = 0.5 * (left.distance - right.distance);
            // Of a point on a wall the direction from that is not known, but opposite to the other.
            let from = |wall: Point2| (foot - wall).try_normalize(0.0).unwrap_or_else(Vector2::zeros);
            let slope = 0.5 * (from(left.point) - from(right.point));
            if slope.norm_squared() < 1e-6 {
                break;
            }
            foot -= slope * (apart / slope.norm_squared());
        }
        foot
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]
    use super::*;
    use crate::geometry::{Piece, circle};
    use proptest::prelude::*;

    proptest! {
        /// Equally far from a straight wall and from a round post is a parabola.
        #[test]
        fn between_a_straight_wall_and_a_post_it_is_a_parabola(x in -0.1..0.1_f64, off in -0.02..0.02_f64) {
            let (height, radius) = (0.3, 0.1);
            let straight = |y| Contour::open(vec![Piece::segment(Point2::new(-2.0, y), Point2::new(2.0, y))]).unwrap();
            let post = circle(Point2::new(0.0, height), radius).unwrap();
            let axis = TunnelAxis::new(straight(0.1), post, straight(0.0));
            // y = distance from the centre - radius: x² = (y + radius)² - (height - y)².
            let y = (x * x + height * height - radius * radius) / (2.0 * (height + radius));
            let normal = Vector2::new(-x / (height + radius), 1.0).normalize();
            let distance = axis.distance(Point2::new(x, y) + off * normal).unwrap();
            prop_assert!((distance - off.abs()).abs() < 2e-5, "{distance} for {off}");
        }
    }
}
