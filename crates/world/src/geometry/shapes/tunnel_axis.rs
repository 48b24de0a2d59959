//! The axis of a tunnel.

use crate::geometry::{Contour, Point2, Vector2, perpendicular};

/// The number of Newton steps towards the axis. Convergence is quadratic, from an initial error of millimetres at a
/// distance of a decimetre from either wall.
const STEPS: usize = 6;

/// The axis of a tunnel: the line with equal distances from its left and its right wall (section 5.3 of the baseline).
///
/// If both walls are parallels of their common line, the axis is that line, except around the corners of straight runs.
/// There it is slightly nearer to the inner corner. Walls at a radial distance are not parallel.
#[derive(Clone, Debug)]
pub struct TunnelAxis {
    line: Contour,
    left: Contour,
    right: Contour,
}

impl TunnelAxis {
    /// Creates the axis between the inner sides of two walls. The common `line` of the walls defines the beginning and
    /// the end of the tunnel.
    #[must_use]
    pub fn new(line: Contour, left: Contour, right: Contour) -> Self {
        Self { line, left, right }
    }

    /// The common line of the walls, closed in a round tunnel.
    #[must_use]
    pub fn line(&self) -> &Contour {
        &self.line
    }

    /// The inner side of the left wall, a parallel of the line without openings.
    #[must_use]
    pub fn left(&self) -> &Contour {
        &self.left
    }

    /// The inner side of the right wall.
    #[must_use]
    pub fn right(&self) -> &Contour {
        &self.right
    }

    /// The arc length (m) of a point between the walls, projected on the [line](Self::line). `None` for a point beyond
    /// a wall, before the beginning of the tunnel or beyond its end.
    #[must_use]
    pub fn arc_length_between(&self, point: Point2) -> Option<f64> {
        let left_of = |wall: &Contour| {
            let nearest = wall.nearest(point);
            perpendicular(wall.tangent_at(nearest.arc_length)).dot(&(point - nearest.point))
        };
        let is_between = left_of(&self.left) < 0.0 && left_of(&self.right) > 0.0;
        self.arc_length_beside(point).filter(|_| is_between)
    }

    /// The distance (m) of a point from the axis, never negative. `None` before the beginning of the tunnel and beyond
    /// its end.
    ///
    /// ```
    /// use vibrissa_world::geometry::{Contour, Piece, Point2, TunnelAxis};
    /// let up = |x| Contour::open(vec![Piece::segment(Point2::new(x, 0.0), Point2::new(x, 1.0))]);
    /// let axis = TunnelAxis::new(up(0.0)?, up(-0.12)?, up(0.1)?);
    /// assert!((axis.distance(Point2::new(0.0, 0.5)).unwrap() - 0.01).abs() < 1e-12);
    /// assert_eq!(axis.distance(Point2::new(0.0, 1.5)), None);
    /// # Ok::<(), vibrissa_world::geometry::ContourError>(())
    /// ```
    #[must_use]
    pub fn distance(&self, point: Point2) -> Option<f64> {
        self.arc_length_beside(point).map(|_| (self.project(point) - point).norm())
    }

    /// Points of the axis from the beginning of the tunnel to its end, at distances of at most `step` (m) along the line.
    #[must_use]
    pub fn points(&self, step: f64) -> Vec<Point2> {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a positive number of points")]
        let count = (self.line.length() / step).ceil().clamp(1.0, 1e6) as usize;
        let share = |index: usize| self.line.length() * index as f64 / count as f64;
        (0..=count).map(|index| self.project(self.line.point_at(share(index)))).collect()
    }

    /// The arc length (m) of a point projected on the line. `None` before the beginning of the tunnel and beyond its
    /// end.
    fn arc_length_beside(&self, point: Point2) -> Option<f64> {
        let (_, along) = self.line.nearest_point(point);
        let is_inside = self.line.is_closed() || (along > 0.0 && along < self.line.length());
        is_inside.then_some(along)
    }

    /// A point of the axis, found by the difference of the distances from both walls. It is the nearest one, except for
    /// the curvature of the axis within the distance.
    fn project(&self, point: Point2) -> Point2 {
        let mut projection = point;
        for _ in 0..STEPS {
            let [left, right] =
                [&self.left, &self.right].map(|wall| (wall.nearest_point(projection).0, wall.distance(projection)));
            let apart = 0.5 * (left.1 - right.1);
            // For a point on a wall, the direction from that wall is undefined. It is opposite to that from the other
            // wall.
            let from = |wall: Point2| (projection - wall).try_normalize(0.0).unwrap_or_else(Vector2::zeros);
            let slope = 0.5 * (from(left.0) - from(right.0));
            if slope.norm_squared() < 1e-6 {
                break;
            }
            projection -= slope * (apart / slope.norm_squared());
        }
        projection
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]
    use super::*;
    use crate::geometry::{Piece, circle};
    use proptest::prelude::*;

    #[test]
    fn only_points_between_the_walls_have_an_arc_length() {
        let up = |x| Contour::open(vec![Piece::segment(Point2::new(x, 0.0), Point2::new(x, 1.0))]).unwrap();
        let axis = TunnelAxis::new(up(0.0), up(-0.12), up(0.1));
        assert_eq!(axis.arc_length_between(Point2::new(0.09, 0.5)), Some(0.5));
        assert_eq!(axis.arc_length_between(Point2::new(0.11, 0.5)), None);
        assert_eq!(axis.arc_length_between(Point2::new(0.0, 1.5)), None);
    }

    proptest! {
        /// The points with equal distances from a straight wall and from a round post are a parabola.
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

        #[test]
        fn its_points_have_equal_distances_from_both_walls(height in 0.25..0.4_f64, step in 0.005..0.1_f64) {
            let straight = |y: f64, from: f64| {
                Contour::open(vec![Piece::segment(Point2::new(-from, y), Point2::new(from, y))]).unwrap()
            };
            let post = circle(Point2::new(0.0, height), 0.1).unwrap();
            let axis = TunnelAxis::new(straight(0.5 * (height - 0.1), 0.1), post.clone(), straight(0.0, 2.0));
            let points = axis.points(step);
            prop_assert!(points.len() as f64 * step >= 0.2);
            for point in points {
                prop_assert!((post.nearest(point).distance - point.y.abs()).abs() < 1e-9);
            }
        }
    }
}
