//! How far an unnoticed contact displaces a straight shaft.

use crate::math;
use crate::rig::Whisker;

/// Number of positions along a shaft, from its base to its tip, for which the displacement is stored.
const PLACES: usize = 9;

/// The lateral displacement of a shaft whose base angle is small.
///
/// Loads push the shaft to one side. Among all such loads with one base moment, a single load at the tip displaces every
/// point of the shaft most. A load at `c` has the moment `M (1 − x/c)` at the distance `x` from the base, and this grows
/// with `c`. So for a base angle of at most `θ`, the displacement at the distance `s` is at most
/// `d(s) = θ (s + k ∫₀ˢ (s − x)(1 − x/L) / EI(x) dx)`, with the stiffness `k` of the hinge and the bending stiffness
/// `EI(x)`. For a uniform shaft this is `θ k L² / 3 EI` at the tip, and the first term is negligible.
#[derive(Debug, Clone)]
pub(super) struct Margins {
    /// Length of the shaft (m).
    pub(super) length: f64,
    /// Displacements (m/rad) at the positions for a base angle of 1 rad.
    displacements: [f64; PLACES],
}

/// Steps of the integration in each part between two positions.
const STEPS: usize = 32;
/// Share of the square of the tip's displacement over the length by which a load at the tip shortens a uniform shaft.
const SHORTENING: f64 = 0.6;

impl Margins {
    /// Creates the displacements of the shaft of `whisker`, as perception models it.
    pub(super) fn new(whisker: &Whisker) -> Self {
        let shaft = &whisker.shaft;
        let length = shaft.length;
        let step = length / ((PLACES - 1) * STEPS) as f64;
        let (mut slope, mut displacement) = (1.0, 0.0);
        let displacements = std::array::from_fn(|place| {
            for index in 0..if place == 0 { 0 } else { STEPS } {
                let share = (((place - 1) * STEPS + index) as f64 + 0.5) * step / length;
                let stiffness =
                    shaft.young_modulus * std::f64::consts::FRAC_PI_4 * math::powi(shaft.radius_at(share), 4);
                let bend = whisker.hinge.stiffness * (1.0 - share) / stiffness * step;
                displacement += (slope + 0.5 * bend) * step;
                slope += bend;
            }
            displacement
        });
        Self { length, displacements }
    }

    /// The displacement (m) at the distance `along` (m) from the base, for a base angle (rad). Between positions it is
    /// interpolated, which is more than the exact one, because the shaft is convex.
    pub(super) fn displacement(&self, along: f64, base_angle: f64) -> f64 {
        let place = (along / self.length).clamp(0.0, 1.0) * (PLACES - 1) as f64;
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a small index")]
        let below = (place.floor() as usize).min(PLACES - 2);
        let (a, b) = (self.displacements[below], self.displacements[below + 1]);
        base_angle * (a + (b - a) * (place - below as f64))
    }

    /// Length (m) by which an object may overlap the tip of a straight shaft and displace it so little.
    pub(super) fn shortening(&self, base_angle: f64) -> f64 {
        SHORTENING * math::square(base_angle * self.displacements[PLACES - 1]) / self.length
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]

    use std::f64::consts::FRAC_PI_2;

    use proptest::prelude::*;

    use super::*;
    use crate::mechanics::Elastica;
    use crate::rig::Rig;

    proptest! {
        /// The oracle is the exact elastica under a small load.
        #[test]
        fn the_displacement_is_that_of_the_elastica_under_a_load_at_the_tip(
            share in 0.1..1.0_f64, taper in prop_oneof![Just(1.0), 0.6..1.0_f64], force in 1e-4..1e-3_f64,
        ) {
            let mut whisker = Rig::default().whiskers.remove(0);
            whisker.shaft.tip_radius = Some(taper * whisker.shaft.radius);
            let unit = whisker.shaft.bending_stiffness() / math::square(whisker.shaft.length);
            let load = |share: f64| Elastica::new(&whisker).under(share * whisker.shaft.length, FRAC_PI_2, force * unit).unwrap();
            let margins = Margins::new(&whisker);
            let tip = load(1.0);
            let found = margins.displacement(whisker.shaft.length, tip.base_angle.abs());
            prop_assert!((found / tip.tip_base.y.abs() - 1.0).abs() < 2e-3, "{found} {}", tip.tip_base.y);
            // A load elsewhere displaces its own place by no more, for the same base angle.
            let shaft = load(share);
            let bound = margins.displacement(share * whisker.shaft.length, shaft.base_angle.abs());
            prop_assert!(bound > shaft.contact_base.y.abs() * 0.999, "{bound} {}", shaft.contact_base.y);
            let beyond = margins.displacement(whisker.shaft.length, shaft.base_angle.abs());
            prop_assert!(beyond > shaft.tip_base.y.abs() * 0.999);
        }
    }

    #[test]
    fn a_uniform_shaft_has_the_displacement_of_the_closed_form() {
        let whisker = Rig::default().whiskers.remove(0);
        let closed = whisker.hinge.stiffness * 0.01 / (3.0 * whisker.shaft.bending_stiffness());
        let found = Margins::new(&whisker).displacement(0.1, 5e-6);
        assert!((found / (5e-6 * (closed + 0.1)) - 1.0).abs() < 1e-4, "{found}");
        assert!((found - 0.87e-3).abs() < 5e-6);
    }
}
