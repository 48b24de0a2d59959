//! Cubic Bézier curves.

use super::fit::fit;
use super::{Piece, Point2, Vector2};

/// The initial number of parts. A cubic changes the sign of its curvature at most twice.
const PARTS: u32 = 2;

/// The distance (m) of control points from the chord within which the curve is straight.
const STRAIGHT: f64 = 1e-9;

/// A cubic Bézier curve.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Bezier {
    /// The start, the two control points and the end (m).
    pub control: [Point2; 4],
}

impl Bezier {
    /// The quadratic curve from `start` to `end` (m) with one control point, a parabola.
    #[must_use]
    pub fn quadratic(start: Point2, pull: Point2, end: Point2) -> Self {
        let towards = |from: Point2| from + (pull - from) * (2.0 / 3.0);
        Self { control: [start, towards(start), towards(end), end] }
    }

    /// Approximates the curve by pieces within a micrometre, from its start to its end. Corners occur only at its
    /// cusps. A straight curve gives one piece, a point none. `None` if a coordinate is not finite.
    ///
    /// ```
    /// use vibrissa_world::geometry::{Bezier, Contour, Point2};
    /// let [a, b, c, d] = [(0.0, 0.0), (0.0, 0.1), (0.2, 0.1), (0.2, 0.0)].map(|(x, y)| Point2::new(x, y));
    /// let arch = Contour::open(Bezier { control: [a, b, c, d] }.pieces().unwrap())?;
    /// assert!(arch.nearest(Point2::new(0.1, 0.075)).distance < 1e-6);
    /// # Ok::<(), vibrissa_world::geometry::ContourError>(())
    /// ```
    #[must_use]
    pub fn pieces(&self) -> Option<Vec<Piece>> {
        let [start, .., end] = self.control;
        if self.control.iter().all(|point| (point - start).norm() <= STRAIGHT) {
            return Some(Vec::new());
        }
        if self.is_straight() {
            return Some(vec![Piece::segment(start, end)]);
        }
        fit(|share| (self.point(share), self.direction(share)), 0.0, 1.0, PARTS)
    }

    /// True if the curve moves along its chord without reversal.
    fn is_straight(&self) -> bool {
        let [start, first, second, end] = self.control;
        let Some(along) = (end - start).try_normalize(STRAIGHT) else { return false };
        let beside = |point: Point2| along.perp(&(point - start)).abs();
        let ahead = |point: Point2| along.dot(&(point - start));
        let marks = [0.0, ahead(first), ahead(second), ahead(end)];
        beside(first) <= STRAIGHT && beside(second) <= STRAIGHT && marks.is_sorted()
    }

    fn point(&self, share: f64) -> Point2 {
        let [a, b, c, d] = self.control.map(|point| point.coords);
        let rest = 1.0 - share;
        let inner = (b * rest + c * share) * (3.0 * rest * share);
        Point2::from(a * (rest * rest * rest) + inner + d * (share * share * share))
    }

    /// The direction of travel. If control points coincide with an end, the next one determines it.
    fn direction(&self, share: f64) -> Vector2 {
        let [a, b, c, d] = self.control;
        let rest = 1.0 - share;
        let velocity = (b - a) * (rest * rest) + (c - b) * (2.0 * rest * share) + (d - c) * (share * share);
        if velocity.norm() > 0.0 {
            velocity
        } else if share < 0.5 {
            if c == a { d - a } else { c - a }
        } else if b == d {
            d - a
        } else {
            d - b
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]

    use proptest::prelude::*;

    use super::*;

    fn point() -> impl Strategy<Value = Point2> {
        (-0.3..0.3_f64, -0.3..0.3_f64).prop_map(|(x, y)| Point2::new(x, y))
    }

    /// The largest distance of the curve from its pieces.
    fn max_deviation(curve: &Bezier, pieces: &[Piece]) -> f64 {
        let places = (0..=2000).map(|k| curve.point(f64::from(k) / 2000.0));
        let off = |place| pieces.iter().map(|piece| piece.distance(place)).fold(f64::INFINITY, f64::min);
        places.map(off).fold(0.0, f64::max)
    }

    proptest! {
        #[test]
        fn the_pieces_lie_on_the_curve_and_follow_each_other(control in [point(), point(), point(), point()]) {
            let curve = Bezier { control };
            let pieces = curve.pieces().unwrap();
            prop_assert!(max_deviation(&curve, &pieces) <= 1.1e-6);
            prop_assert!(pieces.windows(2).all(|pair| (pair[1].start() - pair[0].end()).norm() < 1e-9));
            let turn = |pair: &[Piece]| pair[0].tangent_at(pair[0].length()).angle(&pair[1].tangent_at(0.0));
            prop_assert!(pieces.windows(2).all(|pair| turn(pair) < 1e-3));
        }

        #[test]
        fn ends_may_coincide_with_what_pulls_at_them(start in point(), pull in point(), end in point()) {
            for control in [[start, start, pull, end], [start, pull, end, end], [start, start, end, end]] {
                let pieces = Bezier { control }.pieces().unwrap();
                prop_assert!((pieces[0].start() - start).norm() < 1e-9);
                prop_assert!((pieces[pieces.len() - 1].end() - end).norm() < 1e-9);
            }
        }
    }

    /// A case that the first property once found.
    #[test]
    fn a_curve_with_a_tight_bend_is_followed() {
        let control =
            [(0.277_428, -0.243_496), (0.207_326, 0.111_083), (0.217_137, -0.138_287), (0.295_123, -0.053_671)];
        let curve = Bezier { control: control.map(|(x, y)| Point2::new(x, y)) };
        assert!(max_deviation(&curve, &curve.pieces().unwrap()) <= 1.1e-6);
    }

    #[test]
    fn what_is_straight_is_one_segment_and_what_is_no_curve_is_none() {
        let at = |x, y| Point2::new(x, y);
        let straight = Bezier { control: [at(0.0, 0.0), at(0.1, 0.1), at(0.1, 0.1), at(0.3, 0.3)] };
        assert_eq!(straight.pieces(), Some(vec![Piece::segment(at(0.0, 0.0), at(0.3, 0.3))]));
        let cusp = Bezier { control: [at(0.0, 0.0), at(0.1, 0.1), at(0.0, 0.1), at(0.1, 0.0)] };
        assert!(max_deviation(&cusp, &cusp.pieces().unwrap()) <= 1.1e-6);
        assert_eq!(Bezier { control: [at(0.1, 0.0); 4] }.pieces(), Some(Vec::new()));
        assert_eq!(Bezier { control: [at(0.0, 0.0), at(f64::NAN, 0.0), at(1.0, 0.0), at(1.0, 1.0)] }.pieces(), None);
    }

    #[test]
    fn a_quadratic_curve_is_its_parabola() {
        let curve = Bezier::quadratic(Point2::new(0.0, 0.0), Point2::new(0.1, 0.2), Point2::new(0.2, 0.0));
        for k in 0..=10 {
            let x = 0.02 * f64::from(k);
            assert!((curve.point(x / 0.2) - Point2::new(x, 10.0 * x * (0.2 - x))).norm() < 1e-15);
        }
    }
}
