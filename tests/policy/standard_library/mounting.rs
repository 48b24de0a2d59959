//! Whiskers that are swept back, and whiskers that point forward.

use std::f64::consts::{FRAC_PI_2, PI};

use proptest::prelude::*;
use vibrissa_runtime::geometry::{Pose, unit};
use vibrissa_runtime::machine::Turn;

use super::felt::{Felt, swiping};
use super::law::{commanded, is_near, unit_vector};

/// The yaw offset (rad) and the direction of travel that a policy reads.
fn offset(whisker: usize, felt: &Felt) -> (f64, vibrissa_runtime::geometry::Vector2) {
    let does = "steer body along direction(travel_heading(w)) at 1 mm/s turning mounting_offset(w) / 1 s";
    let (_, along, _, turn) = commanded(whisker, does, felt);
    let Turn::Rate(rate) = turn else { panic!("{turn:?}") };
    (rate, along)
}

proptest! {
    #[test]
    fn a_whisker_that_is_swept_back_changes_nothing(
        whisker in 0_usize..2, heading in -PI..PI, mounting in FRAC_PI_2 + 1e-9..PI,
    ) {
        let felt = Felt { mounting, ..Felt::at(Pose { heading, ..Pose::default() }) };
        let (offset, along) = offset(whisker, &felt);
        prop_assert_eq!(offset.abs().to_bits(), 0.0_f64.to_bits());
        prop_assert_eq!(along, unit(heading));
    }

    /// The angle between a whisker and the surface is that of its mirror image, which is swept back.
    #[test]
    fn one_that_points_forward_trails_by_as_much_with_the_body_turned_to_the_surface(
        whisker in 0_usize..2, travel in -PI..PI, forward in 1e-3..1.2_f64,
    ) {
        let heading = travel + 2.0 * forward * Felt::side(whisker);
        let felt = Felt { mounting: FRAC_PI_2 - forward, ..Felt::at(Pose { heading, ..Pose::default() }) };
        let (offset, along) = offset(whisker, &felt);
        prop_assert!((offset - (heading - travel)).abs() < 1e-9);
        prop_assert!(is_near(along, unit(travel)));
        let to_surface = felt.yaw(whisker) - travel;
        prop_assert!((to_surface - (FRAC_PI_2 + forward) * Felt::side(whisker)).abs() < 1e-9);
    }

    #[test]
    fn laws_turn_the_body_to_that_offset_and_no_farther(whisker in 0_usize..2, travel in -PI..PI, forward in 0.0..1.2_f64) {
        let (surface, mounting) = (unit_vector(unit(travel)), FRAC_PI_2 - forward);
        for law in [
            format!("do follow(w, {surface}, 300 urad * w.side, 50 mm/s, 0 deg)"),
            format!("do return_to_edge(w, body.position, {surface}, 9 mm, 50 mm/s)"),
            format!("do reposition(w, body.position, {surface}, 9 mm, 0 deg, 50 mm/s)"),
        ] {
            let rate = |error: f64| {
                let heading = travel + 2.0 * forward * Felt::side(whisker) + error;
                let felt = Felt { mounting, body: Pose { heading, ..Pose::default() }, ..swiping(whisker, 1.0) };
                match commanded(whisker, &law, &felt).3 {
                    Turn::Rate(rate) => rate,
                    Turn::Facing(heading) => panic!("{heading}"),
                }
            };
            prop_assert!(rate(0.0).abs() < 1e-9 && rate(0.1) < 0.0 && rate(-0.1) > 0.0, "{law}");
        }
    }
}
