//! Smooth closed curves around a centre.

use std::f64::consts::TAU;

use vibrissa_runtime::math;

use super::ShapeError;
use super::error::{finite, finite_point, positive};
use crate::geometry::fit::{MIN_PARTS, fit, most_arcs};
use crate::geometry::{Contour, Point2, Vector2, perpendicular, unit};

/// The number of samples per wave for the bound on the number of arcs.
pub(super) const PLACES_PER_WAVE: u32 = 32;

/// A harmonic of a polar curve: `a cos(n θ + φ)` is added to the radius.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Harmonic {
    /// The number of waves `n` per turn.
    pub order: u32,
    /// The amplitude `a` (m).
    pub amplitude: f64,
    /// The phase `φ` (rad).
    pub phase: f64,
}

/// The closed curve `r = R + Σ a cos(n θ + φ)` around a centre (m), with the mean radius `R` (m) and these harmonics.
/// It is approximated by arcs within a micrometre.
///
/// ```
/// use vibrissa_world::geometry::{Harmonic, Point2, polar_curve};
/// let egg = polar_curve(Point2::origin(), 0.2, &[Harmonic { order: 2, amplitude: 0.02, phase: 0.0 }])?;
/// assert!((egg.nearest(Point2::new(0.3, 0.0)).distance - 0.08).abs() < 1e-6);
/// assert!(egg.corners().is_empty());
/// # Ok::<(), vibrissa_world::geometry::ShapeError>(())
/// ```
///
/// # Errors
/// If a number is not finite, the radius is not positive, or the harmonics together are as large as the radius, or too fine to
/// be fitted.
pub fn polar_curve(centre: Point2, radius: f64, harmonics: &[Harmonic]) -> Result<Contour, ShapeError> {
    finite_point("centre", centre)?;
    positive("radius", radius)?;
    for harmonic in harmonics {
        finite("amplitude", harmonic.amplitude)?;
        finite("phase", harmonic.phase)?;
    }
    // With a radius that is not positive, the curve would pass through its centre.
    positive("least radius", radius - harmonics.iter().map(|harmonic| harmonic.amplitude.abs()).sum::<f64>())?;
    let curve = |angle: f64| {
        let (mut distance, mut growth) = (radius, 0.0);
        for &Harmonic { order, amplitude, phase } in harmonics {
            let (sin, cos) = math::sin_cos(f64::from(order) * angle + phase);
            distance += amplitude * cos;
            growth -= f64::from(order) * amplitude * sin;
        }
        let outward = unit(angle);
        (centre + distance * outward, growth * outward + distance * perpendicular(outward))
    };
    let pieces = fit(curve, 0.0, TAU, MIN_PARTS).ok_or(ShapeError::TooFine)?;
    Ok(Contour::closed(pieces)?)
}

/// An upper bound of the number of pieces of [`polar_curve`]. It is a few times too large. It is meaningless if the
/// curve does not exist.
#[must_use]
pub(crate) fn polar_curve_pieces(radius: f64, harmonics: &[Harmonic]) -> usize {
    let derivatives = |angle: f64| {
        let mut distance = [radius, 0.0, 0.0, 0.0];
        for &Harmonic { order, amplitude, phase } in harmonics {
            let order = f64::from(order);
            let (sin, cos) = math::sin_cos(order * angle + phase);
            for (derivative, value) in
                distance.iter_mut().zip([cos, -order * sin, -math::square(order) * cos, math::powi(order, 3) * sin])
            {
                *derivative += amplitude * value;
            }
        }
        polar_derivatives(angle, distance)
    };
    let finest = harmonics.iter().map(|harmonic| harmonic.order).max().unwrap_or(1);
    most_arcs(derivatives, 0.0, TAU, PLACES_PER_WAVE.saturating_mul(finest.max(1)))
}

/// The derivatives of a point with respect to its angle, from the radius at that angle and its first three derivatives.
pub(super) fn polar_derivatives(angle: f64, [distance, first, second, third]: [f64; 4]) -> [Vector2; 3] {
    let (outward, across) = (unit(angle), perpendicular(unit(angle)));
    [
        first * outward + distance * across,
        (second - distance) * outward + 2.0 * first * across,
        (third - 3.0 * first) * outward + (3.0 * second - distance) * across,
    ]
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn curves_are_where_their_harmonics_say_and_without_corners(
            harmonics in prop::collection::vec((1_u32..7, 0.0..0.02_f64, 0.0..TAU), 0..5),
            angle in 0.0..TAU,
        ) {
            let harmonics: Vec<_> =
                harmonics.into_iter().map(|(order, amplitude, phase)| Harmonic { order, amplitude, phase }).collect();
            let centre = Point2::new(0.3, -0.2);
            let contour = polar_curve(centre, 0.2, &harmonics).unwrap();
            let wave = |wave: &Harmonic| wave.amplitude * math::cos(f64::from(wave.order) * angle + wave.phase);
            let point = centre + (0.2 + harmonics.iter().map(wave).sum::<f64>()) * unit(angle);
            prop_assert!(contour.nearest(point).distance < 1.1e-6);
            prop_assert!(contour.corners().is_empty() && contour.area() > 0.0);
            let told = polar_curve_pieces(0.2, &harmonics);
            prop_assert!(contour.pieces().len() <= told && told <= 8 * contour.pieces().len(), "{} of {told}", contour.pieces().len());
        }
    }

    #[test]
    fn a_curve_through_its_centre_is_refused() {
        let harmonic = Harmonic { order: 3, amplitude: -0.2, phase: 0.0 };
        let error = polar_curve(Point2::origin(), 0.2, &[harmonic]).err();
        assert_eq!(error, Some(ShapeError::NotPositive { what: "least radius", value: 0.0 }));
    }
}
