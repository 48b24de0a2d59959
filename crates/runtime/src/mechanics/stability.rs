//! Stability of a bent whisker against motion out of the plane.

use std::f64::consts::FRAC_PI_2;

use crate::math;

/// The margin (rad) by which a round whisker that trails behind its base stays in the plane of motion. A whisker with a
/// negative margin slips sideways along the surface and leaves the plane.
///
/// `inclination` (rad) is the angle between the shaft at its base and the surface: π/2 if they are perpendicular, less if the
/// shaft is swept back, that is, inclined in the direction in which the tip is bent. `friction` is the coefficient of
/// sliding friction. The margin is `π/2 + atan(friction) − inclination`.
///
/// # Derivation
///
/// Let ψ(s) be the angle of the shaft from the direction opposite to the contact force `F`, and φ(s) a small angle out
/// of the plane. The second variation of the energy is `½ ∫ [EI φ'² − (EI ψ'² + F cos ψ) φ²] ds`. Its Jacobi equation
/// has the solution `φ = sin ψ`, because a rotation of the whisker about the direction of the force does not change the
/// energy. This solution fulfils the condition `φ' = 0` at the free tip. So the second variation is positive if and only
/// if `sin ψ` has no zero from the base to the tip. A trailing tip has ψ > 0, and ψ decreases towards the base. The
/// condition is therefore ψ > 0 at the base. Without friction, the force is perpendicular to the surface, so ψ at the
/// base is π/2 − inclination. Friction on a tip that slides forwards rotates the force backwards by `atan(friction)`, which
/// increases ψ by the same angle.
///
/// Length, diameter, taper and load of the shaft do not occur in the condition. It does not hold for a whisker that
/// touches head-on below the Euler load, or that sticks. Such a whisker may be stable beyond the limit. So may a ribbon.
#[must_use]
pub fn out_of_plane_margin(inclination: f64, friction: f64) -> f64 {
    FRAC_PI_2 + math::atan(friction) - inclination
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]
    use super::*;
    use proptest::prelude::*;

    const LINKS: usize = 400;

    /// The angles ψ (rad) from the base to the tip of a uniform shaft of unit length and stiffness under the `force` at
    /// its tip, by integration of `ψ'' = −force sin ψ` from the tip.
    fn shape(tip: f64, force: f64) -> Vec<f64> {
        let step = (LINKS as f64).recip();
        let (mut angle, mut curvature) = (tip, 0.0);
        let mut angles: Vec<f64> = (0..LINKS)
            .map(|_| {
                let middle = angle;
                curvature += step * force * math::sin(middle);
                angle -= step * curvature;
                middle
            })
            .collect();
        angles.reverse();
        angles
    }

    /// True if the second variation of a clamped chain with these angles ψ is positive definite. The chain's Hessian is
    /// tridiagonal, and positive definite if and only if all pivots of its elimination are positive.
    fn is_stable(angles: &[f64], force: f64) -> bool {
        let step = (LINKS as f64).recip();
        let mut last_pivot: Option<f64> = None;
        angles.iter().enumerate().all(|(link, angle)| {
            let before = link.checked_sub(1).and_then(|link| angles.get(link)).copied();
            let after = angles.get(link + 1).copied();
            let curvatures = [before.map(|before| angle - before), after.map(|after| after - angle)];
            let squares = curvatures.into_iter().flatten().map(|turn| math::square(turn / step));
            let squares: Vec<f64> = squares.collect();
            let square = squares.iter().sum::<f64>() / squares.len() as f64;
            // The clamp is half a link before the middle of the first link.
            let joints = if link == 0 { 2.0 } else { 1.0 } + if after.is_some() { 1.0 } else { 0.0 };
            let diagonal = joints / step - step * (square + force * math::cos(*angle));
            let pivot = diagonal - last_pivot.map_or(0.0, |pivot| math::square(step).recip() / pivot);
            last_pivot = Some(pivot);
            pivot > 0.0
        })
    }

    #[test]
    fn a_light_load_leaves_a_shaft_swept_back_and_a_heavy_one_does_not() {
        let [light, heavy] = [1.0, 6.0].map(|force| (force, shape(0.8, force)));
        assert!(light.1[0] > 0.0 && is_stable(&light.1, light.0), "{}", light.1[0]);
        assert!(heavy.1[0] < 0.0 && !is_stable(&heavy.1, heavy.0), "{}", heavy.1[0]);
    }

    proptest! {
        #[test]
        fn the_second_variation_of_a_trailing_shaft_changes_its_sign_where_the_margin_does(
            tip in 0.05..2.5_f64, force in 0.5..20.0_f64, friction in 0.0..1.0_f64,
        ) {
            let angles = shape(tip, force);
            let base = *angles.first().unwrap();
            // With a second zero, the shaft is bent to both sides.
            prop_assume!(base.abs() > 0.02 && base > -tip && angles.is_sorted());
            let inclination = FRAC_PI_2 + math::atan(friction) - base;
            prop_assert_eq!(is_stable(&angles, force), out_of_plane_margin(inclination, friction) > 0.0, "{}", base);
        }
    }
}
