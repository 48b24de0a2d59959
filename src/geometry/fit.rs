//! Smooth curves as arcs.

use super::{Arc, Piece, Point2, Vector2, perpendicular};

/// How far (m) a fitted arc may lie from its curve.
const TOLERANCE: f64 = 1e-6;

/// Parts that a wave of a few turns is cut into before any fitting.
pub(super) const LEAST_PARTS: u32 = 32;

/// How often a part is halved at most; a smooth curve needs a fraction of it.
const MOST_HALVINGS: u32 = 12;

/// Places between the ends of a part at which its arcs are checked. Between them they may be off by a fiftieth more.
const CHECKS: u32 = 15;

/// An arc flatter than this (m) is drawn as a straight piece: its centre would be too far away to keep its digits.
const LARGEST_RADIUS: f64 = 1e6;

/// Where a curve is at a parameter, and the direction in which it goes, of any length but zero.
pub(super) type Place = (Point2, Vector2);

/// Arcs that lie within a micrometre of the smooth `curve` for parameters between `from` and `to`, and join without corners:
/// pairs of arcs (biarcs) that share ends and directions with the curve. `None` where the curve is not smooth, or its
/// coordinates are no numbers.
///
/// Before any fitting it is cut into so many `parts`: what happens twice in a part could hide from its check.
pub(super) fn fit(curve: impl Fn(f64) -> Place, from: f64, to: f64, parts: u32) -> Option<Vec<Piece>> {
    let mut pieces = Vec::new();
    // The parts that are still to be fitted, the next one last.
    let cut = |index: u32| from + (to - from) * (f64::from(index) / f64::from(parts));
    let mut open: Vec<(f64, f64, u32)> = (0..parts).rev().map(|k| (cut(k), cut(k + 1), 0)).collect();
    while let Some((start, end, halvings)) = open.pop() {
        let arcs = biarc(curve(start), curve(end));
        let strays = |index| {
            let (point, _) = curve(start + (end - start) * (f64::from(index) / f64::from(CHECKS + 1)));
            // What is no number is not close.
            !arcs.iter().any(|arc| arc.distance(point) <= TOLERANCE)
        };
        if !(1..=CHECKS).any(strays) {
            pieces.extend(arcs);
        } else if halvings < MOST_HALVINGS {
            let middle = 0.5 * (start + end);
            open.extend([(middle, end, halvings + 1), (start, middle, halvings + 1)]);
        } else {
            return None;
        }
    }
    Some(pieces)
}

/// How much more a curve may turn between the places than at them: sharp turns of steep waves are met by few places.
const BETWEEN_PLACES: f64 = 1.2;

/// At most how many arcs [`fit`] makes of a curve, a few times too many: from its first three derivatives, taken in so many places.
///
/// Over a length 2 h whose curvature changes evenly, by k' along it, a pair of arcs that shares ends and directions with the curve is
/// off by k'/6 t (h - t)² at the distance t from its middle: by k' (2 h)³ / 324 at most. Halving makes up to twice as many as are needed.
pub(super) fn most_arcs(derivatives: impl Fn(f64) -> [Vector2; 3], from: f64, to: f64, places: u32) -> usize {
    let step = (to - from) / f64::from(places);
    let share = |index: u32| {
        let [first, second, third] = derivatives(from + step * (f64::from(index) + 0.5));
        let speed = first.norm();
        let turning = 3.0 * first.perp(&second) * first.dot(&second) / (speed * speed);
        // The change of the curvature with the parameter, times the square of the speed.
        ((first.perp(&third) - turning).abs() / (speed * 324.0 * TOLERANCE)).cbrt()
    };
    let pairs = 2.0 * step.abs() * (0..places).map(share).sum::<f64>();
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a positive count; a cast of more gives the greatest"
    )]
    let arcs = (2.0 * BETWEEN_PLACES * pairs).ceil() as usize;
    arcs.saturating_add(2 * LEAST_PARTS as usize)
}

/// Two arcs that go from one place to another, leaving the first and reaching the second in its direction.
fn biarc((start, out): Place, (end, into): Place) -> [Piece; 2] {
    let (out, into) = (out.normalize(), into.normalize());
    let chord = end - start;
    // The middle where both arcs have tangents of one length.
    let along = chord.dot(&(out + into));
    let across = 2.0 * (1.0 - out.dot(&into));
    let tangent = chord.norm_squared() / (along + (along * along + across * chord.norm_squared()).sqrt());
    let middle = nalgebra::center(&(start + tangent * out), &(end - tangent * into));
    [arc(start, out, middle), arc(end, -into, middle).reversed()]
}

/// The arc from `start` in direction `out` to `end`.
fn arc(start: Point2, out: Vector2, end: Point2) -> Piece {
    let chord = end - start;
    let half_sweep = out.perp(&chord).atan2(out.dot(&chord));
    let to_centre = chord.norm_squared() / (2.0 * perpendicular(out).dot(&chord));
    if to_centre.is_nan() || to_centre.abs() > LARGEST_RADIUS {
        return Piece::segment(start, end);
    }
    let centre = start + to_centre * perpendicular(out);
    let outward = start - centre;
    let start_angle = outward.y.atan2(outward.x);
    Piece::Arc(Arc { centre, radius: to_centre.abs(), start_angle, sweep: 2.0 * half_sweep })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]

    use std::f64::consts::TAU;

    use proptest::prelude::*;

    use super::*;
    use crate::geometry::{Contour, unit};

    fn wave(amplitude: f64, wave_number: f64) -> impl Fn(f64) -> Place {
        move |x| {
            let (sin, cos) = (wave_number * x).sin_cos();
            (Point2::new(x, amplitude * sin), Vector2::new(1.0, amplitude * wave_number * cos))
        }
    }

    proptest! {
        #[test]
        fn arcs_lie_on_their_curve_and_join_smoothly(amplitude in 0.001..0.3_f64, wave_number in 0.5..12.0_f64) {
            let curve = wave(amplitude, wave_number);
            let contour = Contour::open(fit(&curve, -0.2, 1.5, LEAST_PARTS).unwrap()).unwrap();
            for k in 0..4000 {
                let (point, _) = curve(-0.2 + 1.7 * f64::from(k) / 3999.0);
                prop_assert!(contour.nearest(point).distance <= 1.1 * TOLERANCE);
            }
            prop_assert!(contour.corners().is_empty());
        }
    }

    proptest! {
        #[test]
        fn no_curve_has_more_arcs_than_are_told_before(amplitude in 0.001..0.3_f64, exponent in -0.5..3.0_f64, waves in 0.2..20.0_f64) {
            let wave_number = 10_f64.powf(exponent);
            let to = waves * TAU / wave_number;
            let derivatives = |x: f64| {
                let (sin, cos) = (wave_number * x).sin_cos();
                let slope = amplitude * wave_number;
                [Vector2::new(1.0, slope * cos), Vector2::new(0.0, -slope * wave_number * sin), Vector2::new(0.0, -slope * wave_number.powi(2) * cos)]
            };
            let told = most_arcs(derivatives, 0.0, to, 1000);
            if let Some(arcs) = fit(wave(amplitude, wave_number), 0.0, to, LEAST_PARTS) {
                prop_assert!(arcs.len() <= told && told <= 6 * arcs.len(), "{} of {told}", arcs.len());
            }
        }
    }

    #[test]
    fn a_circle_is_fitted_by_its_own_arcs() {
        let pieces = fit(|t| (Point2::from(0.3 * unit(t)), perpendicular(unit(t))), 0.0, 3.0, LEAST_PARTS).unwrap();
        assert_eq!(pieces.len(), 2 * LEAST_PARTS as usize);
        assert!(pieces.iter().all(|piece| (piece.curvature() - 1.0 / 0.3).abs() < 1e-9));
    }

    #[test]
    fn what_is_no_smooth_curve_has_no_arcs() {
        let corner = |t: f64| (Point2::new(t, t.abs()), Vector2::new(1.0, if t < 0.01 { -1.0 } else { 1.0 }));
        assert_eq!(fit(corner, -1.0, 1.1, LEAST_PARTS), None);
        assert_eq!(fit(|_| (Point2::new(f64::NAN, 0.0), Vector2::x()), 0.0, 1.0, LEAST_PARTS), None);
    }
}
