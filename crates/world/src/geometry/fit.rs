//! Approximation of smooth curves by arcs.

use vibrissa_runtime::math;

use super::{Arc, Piece, Point2, Vector2, perpendicular};

/// The largest distance (m) of an arc from its curve.
const TOLERANCE: f64 = 1e-6;

/// The number of parts of a wave with a few turns before any fitting.
pub(super) const MIN_PARTS: u32 = 32;

/// The largest number of bisections of a part. A smooth curve needs a fraction of it.
const MAX_HALVINGS: u32 = 12;

/// The number of sampled points of a part at which its arcs are checked. Between them the error may be larger by a
/// fiftieth.
const CHECKS: u32 = 15;

/// An arc of a larger radius (m) becomes a segment, because its distant centre has rounding errors.
const MAX_RADIUS: f64 = 1e6;

/// The point of a curve at a parameter, and its derivative, of any non-zero length.
pub(super) type CurvePoint = (Point2, Vector2);

/// Approximates the smooth `curve` between the parameters `from` and `to` by arcs within a micrometre, without corners.
/// Pairs of arcs (biarcs) share ends and directions with the curve. `None` if the curve is not smooth, or if its
/// coordinates are not finite.
///
/// The curve is first divided into `parts`. Features that occur twice in a part could escape its check.
pub(super) fn fit(curve: impl Fn(f64) -> CurvePoint, from: f64, to: f64, parts: u32) -> Option<Vec<Piece>> {
    let mut pieces = Vec::new();
    // The parts that remain to be fitted, the next one last.
    let cut = |index: u32| from + (to - from) * (f64::from(index) / f64::from(parts));
    let mut open: Vec<(f64, f64, u32)> = (0..parts).rev().map(|k| (cut(k), cut(k + 1), 0)).collect();
    while let Some((start, end, halvings)) = open.pop() {
        let arcs = biarc(curve(start), curve(end));
        let strays = |index| {
            let (point, _) = curve(start + (end - start) * (f64::from(index) / f64::from(CHECKS + 1)));
            // This comparison also rejects values that are not a number.
            !arcs.iter().any(|arc| arc.distance(point) <= TOLERANCE)
        };
        if !(1..=CHECKS).any(strays) {
            pieces.extend(arcs);
        } else if halvings < MAX_HALVINGS {
            let middle = 0.5 * (start + end);
            open.extend([(middle, end, halvings + 1), (start, middle, halvings + 1)]);
        } else {
            return None;
        }
    }
    Some(pieces)
}

/// The factor by which the curvature between samples may exceed that at the samples. Steep waves have sharp bends that
/// few samples meet.
const BETWEEN_PLACES: f64 = 1.2;

/// An upper bound of the number of arcs that [`fit`] creates for a curve. It is a few times too large. It follows from
/// the first three derivatives at sampled points.
///
/// Consider a biarc that shares ends and directions with a curve of length 2 h, whose curvature changes linearly with
/// the slope k'. At the distance t from the middle its error is k'/6 t (h - t)², at most k' (2 h)³ / 324. Bisection
/// creates up to twice as many arcs as necessary.
pub(super) fn most_arcs(derivatives: impl Fn(f64) -> [Vector2; 3], from: f64, to: f64, places: u32) -> usize {
    let step = (to - from) / f64::from(places);
    let share = |index: u32| {
        let [first, second, third] = derivatives(from + step * (f64::from(index) + 0.5));
        let speed = first.norm();
        let turning = 3.0 * first.perp(&second) * first.dot(&second) / (speed * speed);
        // The derivative of the curvature with respect to the parameter, times the squared speed.
        math::cbrt((first.perp(&third) - turning).abs() / (speed * 324.0 * TOLERANCE))
    };
    let pairs = 2.0 * step.abs() * (0..places).map(share).sum::<f64>();
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a positive count; a cast of more gives the greatest"
    )]
    let arcs = (2.0 * BETWEEN_PLACES * pairs).ceil() as usize;
    arcs.saturating_add(2 * MIN_PARTS as usize)
}

/// Two arcs from one point to another, with the given directions at both.
pub(super) fn biarc((start, out): CurvePoint, (end, into): CurvePoint) -> [Piece; 2] {
    let (out, into) = (out.normalize(), into.normalize());
    let chord = end - start;
    // The junction at which both arcs have tangents of equal length.
    let along = chord.dot(&(out + into));
    let across = 2.0 * (1.0 - out.dot(&into));
    let tangent = chord.norm_squared() / (along + (along * along + across * chord.norm_squared()).sqrt());
    let middle = nalgebra::center(&(start + tangent * out), &(end - tangent * into));
    [arc(start, out, middle), arc(end, -into, middle).reversed()]
}

/// The arc from `start` in direction `out` to `end`.
fn arc(start: Point2, out: Vector2, end: Point2) -> Piece {
    let chord = end - start;
    let half_sweep = math::atan2(out.perp(&chord), out.dot(&chord));
    let to_centre = chord.norm_squared() / (2.0 * perpendicular(out).dot(&chord));
    if to_centre.is_nan() || to_centre.abs() > MAX_RADIUS {
        return Piece::segment(start, end);
    }
    let centre = start + to_centre * perpendicular(out);
    let outward = start - centre;
    let start_angle = math::atan2(outward.y, outward.x);
    Piece::Arc(Arc { centre, radius: to_centre.abs(), start_angle, sweep: 2.0 * half_sweep })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]

    use std::f64::consts::TAU;

    use proptest::prelude::*;

    use super::*;
    use crate::geometry::{Contour, unit};

    fn wave(amplitude: f64, wave_number: f64) -> impl Fn(f64) -> CurvePoint {
        move |x| {
            let (sin, cos) = math::sin_cos(wave_number * x);
            (Point2::new(x, amplitude * sin), Vector2::new(1.0, amplitude * wave_number * cos))
        }
    }

    proptest! {
        #[test]
        fn arcs_lie_on_their_curve_and_join_smoothly(amplitude in 0.001..0.3_f64, wave_number in 0.5..12.0_f64) {
            let curve = wave(amplitude, wave_number);
            let contour = Contour::open(fit(&curve, -0.2, 1.5, MIN_PARTS).unwrap()).unwrap();
            for k in 0..4000 {
                let (point, _) = curve(-0.2 + 1.7 * f64::from(k) / 3999.0);
                prop_assert!(contour.nearest(point).distance <= 1.1 * TOLERANCE);
            }
            prop_assert!(contour.corners().is_empty());
        }
    }

    /// The number of arcs of some waves, if they can be fitted, and the bound of it.
    fn counts(amplitude: f64, exponent: f64, waves: f64) -> (Option<usize>, usize) {
        let wave_number = math::powf(10.0, exponent);
        let to = waves * TAU / wave_number;
        let derivatives = |x: f64| {
            let (sin, cos) = math::sin_cos(wave_number * x);
            let slope = amplitude * wave_number;
            [
                Vector2::new(1.0, slope * cos),
                Vector2::new(0.0, -slope * wave_number * sin),
                Vector2::new(0.0, -slope * math::square(wave_number) * cos),
            ]
        };
        let arcs = fit(wave(amplitude, wave_number), 0.0, to, MIN_PARTS).map(|arcs| arcs.len());
        (arcs, most_arcs(derivatives, 0.0, to, 1000))
    }

    /// A case that the property below once found.
    #[test]
    fn many_steep_waves_have_no_more_arcs_than_the_bound() {
        let (arcs, bound) = counts(0.271_822_320_338_052_26, 2.995_628_874_328_302_6, 9.047_173_273_905_189);
        assert!(arcs.is_none_or(|arcs| arcs <= bound), "{arcs:?} of {bound}");
    }

    proptest! {
        #[test]
        fn no_curve_has_more_arcs_than_are_told_before(amplitude in 0.001..0.3_f64, exponent in -0.5..3.0_f64, waves in 0.2..20.0_f64) {
            let (arcs, told) = counts(amplitude, exponent, waves);
            prop_assert!(arcs.is_none_or(|arcs| arcs <= told && told <= 6 * arcs), "{arcs:?} of {told}");
        }
    }

    #[test]
    fn a_circle_is_fitted_by_its_own_arcs() {
        let pieces = fit(|t| (Point2::from(0.3 * unit(t)), perpendicular(unit(t))), 0.0, 3.0, MIN_PARTS).unwrap();
        assert_eq!(pieces.len(), 2 * MIN_PARTS as usize);
        assert!(pieces.iter().all(|piece| (piece.curvature() - 1.0 / 0.3).abs() < 1e-9));
    }

    #[test]
    fn what_is_no_smooth_curve_has_no_arcs() {
        let corner = |t: f64| (Point2::new(t, t.abs()), Vector2::new(1.0, if t < 0.01 { -1.0 } else { 1.0 }));
        assert_eq!(fit(corner, -1.0, 1.1, MIN_PARTS), None);
        assert_eq!(fit(|_| (Point2::new(f64::NAN, 0.0), Vector2::x()), 0.0, 1.0, MIN_PARTS), None);
    }
}
