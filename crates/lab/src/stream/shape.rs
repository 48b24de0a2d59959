//! Polylines of what viewers draw: outlines and bent whiskers.

use vibrissa_runtime::rig::Whisker;
use vibrissa_world::geometry::{Contour, Piece, Point2, unit};

/// The largest distance (m) of a drawn chord from an arc.
const CHORD_ERROR: f64 = 2e-4;
/// The number of points on a drawn whisker.
const SHAFT_POINTS: u32 = 9;

/// The points of a bent shaft (body frame) with a base angle (rad) and a tip. Its shape is the cubic curve from the base to the tip: it
/// begins in the direction of the base, and is not bent at its end, as a uniform shaft under a small force at its tip.
#[must_use]
pub fn shaft_points(whisker: &Whisker, base_angle: f64, tip_body: Point2) -> Vec<Point2> {
    let base = whisker.base_body;
    let start = unit(whisker.direction_body + base_angle);
    let first = base + whisker.shaft.length / 3.0 * start;
    let second = Point2::from((first.coords + tip_body.coords) / 2.0);
    let point = |k: u32| on_curve([base, first, second, tip_body], f64::from(k) / f64::from(SHAFT_POINTS - 1));
    (0..SHAFT_POINTS).map(point).collect()
}

/// A point of a cubic curve.
fn on_curve([a, b, c, d]: [Point2; 4], t: f64) -> Point2 {
    let s = 1.0 - t;
    let sum = s * s * s * a.coords + 3.0 * s * s * t * b.coords + 3.0 * s * t * t * c.coords + t * t * t * d.coords;
    Point2::from(sum)
}

/// The points of a drawn contour: the ends of its pieces, and points on its arcs.
pub fn outline_points(contour: &Contour) -> Vec<Point2> {
    let mut points: Vec<Point2> = contour.pieces().iter().flat_map(piece_points).collect();
    points.extend(contour.pieces().last().filter(|_| !contour.is_closed()).map(Piece::end));
    points
}

/// The points of a piece without its end.
fn piece_points(piece: &Piece) -> Vec<Point2> {
    // A chord of the length c is at most c² κ / 8 away from its arc.
    let chord = (8.0 * CHORD_ERROR / piece.curvature().abs()).sqrt();
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to a small positive number")]
    let count = (piece.length() / chord).ceil().clamp(1.0, 1e4) as u32;
    (0..count).map(|k| piece.point_at(piece.length() * f64::from(k) / f64::from(count))).collect()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]
    use super::*;
    use proptest::prelude::*;
    use vibrissa_world::geometry::{circle, polygon};

    proptest! {
        #[test]
        fn a_drawn_outline_is_nowhere_farther_from_the_contour_than_a_chord_may_be(radius in 0.01..1.0_f64) {
            let contour = circle(Point2::new(0.3, 0.2), radius).unwrap();
            let points = outline_points(&contour);
            for pair in points.windows(2) {
                prop_assert!(contour.nearest(nalgebra::center(&pair[0], &pair[1])).distance < 1.001 * CHORD_ERROR);
            }
            prop_assert!(points.len() < 1000);
        }
    }

    #[test]
    fn a_polygon_keeps_its_corners() {
        let corners = [Point2::origin(), Point2::new(0.5, 0.0), Point2::new(0.2, 0.4)];
        assert_eq!(outline_points(&polygon(&corners).unwrap()), corners);
    }
}
