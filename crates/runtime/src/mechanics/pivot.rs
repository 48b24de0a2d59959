//! A shaft that rests on a fixed point, in closed form.

use std::f64::consts::FRAC_PI_2;

use nalgebra::Vector2;

use crate::math;
use crate::rig::Whisker;

/// A whisker's shaft under a force perpendicular to it, as from a frictionless corner. The closed form takes some ten
/// nanoseconds, where [`Elastica`](super::Elastica) takes microseconds.
///
/// Let `δ` be the rotation of a uniform shaft between its base and the force, `κ` the curvature at the base and `c` the
/// length to the force. Then `c κ = √(sin δ) ∫ dθ / √(sin θ)`. Along the shaft's direction at the force, the distance
/// from the base is `2 sin δ / κ`. Perpendicular to it the distance is `√(sin δ) ∫ √(sin θ) dθ / κ`. The integrals are
/// from 0 to `δ`. They are evaluated as series, exact to 0.1 % up to `δ = π/2`. A tapered shaft bends like a uniform
/// one whose stiffness is smaller by the ratio of the radii at the force and at the base. This is exact for small
/// bends.
#[derive(Debug, Clone, Copy)]
pub struct Pivot {
    /// Length of the shaft (m).
    length: f64,
    /// Base angle (rad) per curvature at the base (1/m).
    hinge_compliance: f64,
    /// Ratio of the radii at the tip and at the base.
    taper: f64,
}

/// Largest rotation `δ` (rad) of the series.
const MAX_BENDING_ANGLE: f64 = FRAC_PI_2;
/// Number of Newton steps. It suffices for every rotation within the range of the series.
const NEWTON_STEPS: usize = 3;
/// Angle (rad) to a surface below which a shaft is taken to lie along it.
const NEARLY_FLAT: f64 = 0.03;

impl Pivot {
    /// Creates the closed form for the shaft of `whisker`.
    #[must_use]
    pub fn new(whisker: &Whisker) -> Self {
        let shaft = &whisker.shaft;
        Self {
            length: shaft.length,
            hinge_compliance: shaft.bending_stiffness() / whisker.hinge.stiffness,
            taper: shaft.taper(),
        }
    }

    /// The contact position (m, frame of the base) of a shaft that rests at the length `contact_length` (m) and has the
    /// base angle `base_angle` (rad). `None` if the bend exceeds the range of the closed form.
    #[must_use]
    pub fn contact_base(&self, base_angle: f64, contact_length: f64) -> Option<Vector2<f64>> {
        let bending_angle = self.bending_angle(base_angle, contact_length)?;
        let (along, across) = lever(bending_angle);
        let scale = contact_length / along_the_shaft(bending_angle);
        let (sin, cos) = math::sin_cos(base_angle.abs() + bending_angle);
        let contact_base = scale * Vector2::new(along * cos + across * sin, along * sin - across * cos);
        Some(Vector2::new(contact_base.x, base_angle.signum() * contact_base.y))
    }

    /// True if a shaft with the base angle `base_angle` (rad) lies along a surface, and does not touch it with its tip
    /// alone. `normal` is the direction of the surface normal (rad, frame of the base), for a bend to the left.
    #[must_use]
    pub fn lies_flat(&self, base_angle: f64, normal: f64) -> bool {
        let square = self
            .bending_angle(base_angle, self.length)
            .map(|bending_angle| base_angle.abs() + bending_angle + FRAC_PI_2);
        square.is_none_or(|square| normal < square + NEARLY_FLAT)
    }

    /// The rotation `δ` (rad, not 0) between the base and a force at the length `contact_length` (m), for a base angle
    /// (rad).
    fn bending_angle(&self, base_angle: f64, contact_length: f64) -> Option<f64> {
        let turn = contact_length * base_angle.abs() / self.softened_compliance(contact_length);
        let mut bending_angle = math::max(0.5 * turn, f64::EPSILON);
        for _ in 0..NEWTON_STEPS {
            bending_angle -= (along_the_shaft(bending_angle) - turn) / (2.0 - 0.4 * bending_angle * bending_angle);
        }
        (bending_angle <= MAX_BENDING_ANGLE).then_some(math::max(bending_angle, f64::EPSILON))
    }

    /// The base angle (rad) of a sufficiently long shaft that rests on a position (m, frame of the base). `None` if the
    /// bend exceeds the range of the closed form.
    #[must_use]
    pub fn base_angle(&self, contact_base: Vector2<f64>) -> Option<f64> {
        let (distance, direction) = (contact_base.norm(), math::atan2(contact_base.y.abs(), contact_base.x));
        if distance == 0.0 || distance.is_nan() {
            return None;
        }
        let compliance = self.softened_compliance(math::min(distance, self.length)) / distance;
        let angle = |bending_angle: f64| {
            let (along, across) = lever(bending_angle);
            (compliance * math::hypot(along, across), bending_angle - math::atan2(across, along))
        };
        // To first order, the direction from the base is the hinge angle plus two thirds of the rotation.
        let mut bending_angle = direction / (2.0 / 3.0 + 2.0 * compliance);
        for _ in 0..NEWTON_STEPS {
            let (hinge, turned) = angle(bending_angle);
            bending_angle -= (hinge + turned - direction) / (2.0 / 3.0 + 2.0 * compliance);
        }
        (bending_angle <= MAX_BENDING_ANGLE).then(|| angle(bending_angle).0 * contact_base.y.signum())
    }

    /// Base angle (rad) per curvature at the base (1/m), of the equivalent uniform shaft under a force at the length
    /// `contact_length` (m).
    fn softened_compliance(&self, contact_length: f64) -> f64 {
        self.hinge_compliance * (1.0 - (1.0 - self.taper) * contact_length / self.length)
    }
}

/// Length of the shaft from the base to the force, times the curvature at the base: `c κ = 2 δ (1 − δ²/15)`.
fn along_the_shaft(bending_angle: f64) -> f64 {
    2.0 * bending_angle * (1.0 - bending_angle * bending_angle / 15.0)
}

/// Position of the force relative to the base, times the curvature at the base: along the shaft's direction at the
/// force, and to the right of it.
fn lever(bending_angle: f64) -> (f64, f64) {
    let sin = math::sin(bending_angle);
    let square = bending_angle * bending_angle;
    (
        2.0 * sin,
        math::max(sin, 0.0).sqrt()
            * math::max(bending_angle, 0.0).sqrt()
            * bending_angle
            * (2.0 / 3.0)
            * (1.0 - square / 28.0),
    )
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]

    use proptest::prelude::*;

    use super::*;
    use crate::mechanics::Elastica;
    use crate::rig::Rig;

    proptest! {
        #[test]
        fn a_force_perpendicular_to_the_shaft_bends_it_as_the_elastica_does(
            share in 0.1..1.0_f64,
            force in 0.01..2.2_f64,
            taper in prop_oneof![Just(1.0), 0.6..1.0_f64],
            is_left in any::<bool>(),
        ) {
            let mut whisker = Rig::default().whiskers.remove(0);
            whisker.shaft.tip_radius = Some(taper * whisker.shaft.radius);
            let (shaft, side) = (&whisker.shaft, if is_left { 1.0 } else { -1.0 });
            let (contact, unit) = (share * shaft.length, shaft.tip_stiffness() / math::square(share * shaft.length));
            let shape = Elastica::new(&whisker).under(contact, side * MAX_BENDING_ANGLE, force * unit).unwrap();
            let pivot = Pivot::new(&whisker);
            // For a tapered shaft the closed form is exact only to the first order of the bend. These bounds are close to
            // the largest errors on a grid of 20,000 contacts for each of six tapers.
            let narrowing = 1.0 - taper;
            let angle_tolerance = 1e-3 + narrowing * (0.22 + 0.24 * narrowing);
            let tolerance = 1e-3 + 0.11 * narrowing;
            let angle = pivot.base_angle(shape.contact_base).unwrap();
            prop_assert!((angle / shape.base_angle - 1.0).abs() < angle_tolerance, "{angle} {}", shape.base_angle);
            let contact_base = pivot.contact_base(shape.base_angle, contact).unwrap();
            prop_assert!((contact_base - shape.contact_base).norm() < tolerance * contact, "{contact_base} {}", shape.contact_base);
        }

        #[test]
        fn a_shaft_lies_along_a_surface_perpendicular_to_the_force_at_its_tip(force in 0.01..2.2_f64, lean in -0.5..0.5_f64) {
            prop_assume!((lean - NEARLY_FLAT).abs() > 3e-3);
            let whisker = Rig::default().whiskers.remove(0);
            let unit = whisker.shaft.bending_stiffness() / math::square(whisker.shaft.length);
            let shape = Elastica::new(&whisker).under(whisker.shaft.length, MAX_BENDING_ANGLE, force * unit).unwrap();
            let normal = shape.tip_angle + FRAC_PI_2 + lean;
            prop_assert_eq!(Pivot::new(&whisker).lies_flat(shape.base_angle, normal), lean < NEARLY_FLAT);
        }
    }
}
