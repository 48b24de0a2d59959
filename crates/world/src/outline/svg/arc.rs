//! Arcs of paths, given by their end points.

use vibrissa_runtime::math;

use crate::geometry::Vector2;

/// An elliptic arc, in user units.
pub(super) struct CentreArc {
    pub(super) centre: Vector2,
    /// The semi-axes.
    pub(super) radii: [Vector2; 2],
    pub(super) start_angle: f64,
    pub(super) sweep: f64,
}

/// An arc with the parameters of `A`.
pub(super) struct EndpointArc {
    pub(super) start: Vector2,
    pub(super) end: Vector2,
    pub(super) radii: [f64; 2],
    /// The angle from the x axis to the first radius (rad).
    pub(super) rotation: f64,
    pub(super) is_large: bool,
    /// True if angles increase along the arc.
    pub(super) is_positive: bool,
}

impl EndpointArc {
    /// Returns the arc with its centre, by the conversion of SVG 2, B.2.4. Radii that are too small for the end points
    /// are enlarged. `None` if a radius is 0, because the arc is then a straight line.
    pub(super) fn to_centre_arc(&self) -> Option<CentreArc> {
        let [rx, ry] = self.radii.map(f64::abs);
        let (sin, cos) = math::sin_cos(self.rotation);
        let axes = [Vector2::new(cos, sin), Vector2::new(-sin, cos)];
        // In this frame, the ellipse is the unit circle.
        let to_circle = |offset: Vector2| Vector2::new(axes[0].dot(&offset) / rx, axes[1].dot(&offset) / ry);
        let half = to_circle(0.5 * (self.start - self.end));
        if rx == 0.0 || ry == 0.0 || !half.norm().is_finite() {
            return None;
        }
        let stretch = half.norm().max(1.0);
        let half = half / stretch;
        let (rx, ry) = (rx * stretch, ry * stretch);
        let side = if self.is_large == self.is_positive { -1.0 } else { 1.0 };
        // The line from the middle of the chord to the centre is perpendicular to the chord.
        let far = (1.0 - half.norm_squared()).max(0.0).sqrt();
        let centre = Vector2::new(half.y, -half.x).try_normalize(0.0)? * (side * far);
        let (from, to) = (half - centre, -half - centre);
        let turn = math::atan2(from.perp(&to), from.dot(&to));
        let tau = std::f64::consts::TAU;
        let sweep = if self.is_positive { turn.rem_euclid(tau) } else { -(-turn).rem_euclid(tau) };
        Some(CentreArc {
            centre: 0.5 * (self.start + self.end) + axes[0] * (rx * centre.x) + axes[1] * (ry * centre.y),
            radii: [axes[0] * rx, axes[1] * ry],
            start_angle: math::atan2(from.y, from.x),
            sweep,
        })
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]

    use std::f64::consts::{PI, TAU};

    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn an_arc_given_by_its_ends_is_the_one_about_its_centre(
            rx in 0.1..2.0_f64, ry in 0.1..2.0_f64, rotation in -PI..PI, from in -PI..PI, sweep in -6.2..6.2_f64,
        ) {
            prop_assume!(sweep.abs() > 0.05 && (sweep.abs() - PI).abs() > 0.05);
            let (sin, cos) = math::sin_cos(rotation);
            let centre = Vector2::new(0.3, -0.2);
            let at = |t: f64| centre + rx * math::cos(t) * Vector2::new(cos, sin) + ry * math::sin(t) * Vector2::new(-sin, cos);
            let (is_large, is_positive) = (sweep.abs() > PI, sweep > 0.0);
            let given = EndpointArc { start: at(from), end: at(from + sweep), radii: [rx, ry], rotation, is_large, is_positive };
            let found = given.to_centre_arc().unwrap();
            prop_assert!((found.centre - centre).norm() < 1e-9 && (found.sweep - sweep).abs() < 1e-9);
            prop_assert!((found.start_angle - from).rem_euclid(TAU).min((from - found.start_angle).rem_euclid(TAU)) < 1e-9);
        }
    }

    #[test]
    fn radii_that_are_too_small_grow_to_reach_both_ends() {
        let (start, end) = (Vector2::new(-1.0, 0.0), Vector2::new(1.0, 0.0));
        let given = EndpointArc { start, end, radii: [0.5, 0.25], rotation: 0.0, is_large: false, is_positive: true };
        let found = given.to_centre_arc().unwrap();
        assert!(found.centre.norm() < 1e-15 && (found.radii[1].y - 0.5).abs() < 1e-15);
        assert!((found.sweep - PI).abs() < 1e-15);
        assert!(EndpointArc { radii: [0.0, 1.0], ..given }.to_centre_arc().is_none());
    }
}
