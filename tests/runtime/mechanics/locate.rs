//! Where a whisker is touched follows from the moment and the shear at its base.

use std::f64::consts::{FRAC_PI_2, PI};

use proptest::prelude::*;
use vibrissa::geometry::{Vector2, unit};
use vibrissa_runtime::mechanics::{Elastica, Equilibrium, LocateError, ShaftChain, ShaftShape};
use vibrissa_runtime::rig::Whisker;

use crate::mechanics::whisker::{any, any_tapered, cut, tip_moment};

/// A bend under a force at a share of the length, at an angle from the shaft there, in units of `EI / c²` for the length
/// `c`, of as much less as the shaft tapers.
fn touched(whisker: &Whisker, share: f64, angle: f64, force: f64) -> Option<ShaftShape> {
    let shaft = cut(whisker, share).shaft;
    let force = force * shaft.tip_stiffness() / shaft.length.powi(2);
    let bend = Elastica::new(whisker).under(share * whisker.shaft.length, angle, force)?;
    (bend.base_angle.abs() < 0.5).then_some(bend)
}

/// Whether a bend stays if what touches stays where it is: at the tip a straight surface, which has a direction and a distance, on the
/// shaft a point. Where touch and force could change without moving that, the shaft springs over.
fn stays(whisker: &Whisker, bend: &ShaftShape) -> bool {
    let elastica = Elastica::new(whisker);
    let (length, angle) = (bend.contact_length, bend.force_direction - bend.tip_angle);
    let is_at_tip = length >= whisker.shaft.length;
    // What is kept, after a change of the touch and its force.
    let kept = |off: f64, more: f64| {
        let (length, angle) = if is_at_tip { (length, angle + off) } else { (length * (1.0 + off), angle) };
        let bend = elastica.under(length, angle, bend.force * (1.0 + more))?;
        let place = bend.contact_base / whisker.shaft.length;
        Some(if is_at_tip { Vector2::new(bend.force_direction, place.dot(&unit(bend.force_direction))) } else { place })
    };
    let turn = || {
        let by_place = if is_at_tip { kept(1e-5, 0.0)? - kept(0.0, 0.0)? } else { kept(0.0, 0.0)? - kept(-1e-5, 0.0)? };
        let by_force = kept(0.0, 1e-5)? - kept(0.0, -1e-5)?;
        Some(by_place.x * by_force.y - by_place.y * by_force.x)
    };
    turn().is_some_and(|turn| turn > 0.0)
}

/// Touches with a base angle that stay, on the shaft and at the tip.
fn with_base_angle(whisker: &Whisker, base_angle: f64) -> Vec<ShaftShape> {
    let on_shaft = (1..=6).map(|step| (f64::from(step) / 6.0, FRAC_PI_2));
    let at_tip = (1..=9).map(|step| (1.0, FRAC_PI_2 + f64::from(step) * 0.15));
    let mut found = Vec::new();
    for (share, angle) in on_shaft.chain(at_tip) {
        let at = |force: f64| touched(whisker, share, angle, force);
        let bends_more = |force: f64| at(force).map(|bend| bend.base_angle > base_angle);
        for step in 0..30 {
            let (mut near, mut far) = (0.4 * f64::from(step) + 1e-4, 0.4 * f64::from(step + 1) + 1e-4);
            let Some((first, last)) = bends_more(near).zip(bends_more(far)) else { break };
            if first == last {
                continue;
            }
            for _ in 0..40 {
                let middle = 0.5 * (near + far);
                if bends_more(middle) == Some(first) { near = middle } else { far = middle }
            }
            found.extend(at(near).filter(|bend| stays(whisker, bend)));
        }
    }
    found
}

fn locate(elastica: &Elastica, base_angle: f64, shear: f64) -> Result<ShaftShape, LocateError> {
    elastica.locate(base_angle, shear, &elastica.straight())
}

fn is_found(whisker: &Whisker, bend: &ShaftShape) -> Result<(), TestCaseError> {
    let length = whisker.shaft.length;
    let found = locate(&Elastica::new(whisker), bend.base_angle, bend.shear);
    prop_assert!(found.is_ok(), "{bend:?} {found:?}");
    let found = found.unwrap();
    prop_assert!((found.contact_length - bend.contact_length).abs() < 1e-6 * length, "{bend:?} {found:?}");
    prop_assert!((found.contact_base - bend.contact_base).norm() < 1e-6 * length, "{bend:?} {found:?}");
    prop_assert!((found.force_direction - bend.force_direction).abs() < 1e-5, "{bend:?} {found:?}");
    prop_assert!((found.force / bend.force - 1.0).abs() < 1e-5);
    prop_assert!((found.shear - bend.shear).abs() < 1e-9 * bend.force);
    prop_assert!((found.base_angle / bend.base_angle - 1.0).abs() < 1e-9);
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn a_touch_on_the_shaft_is_found(whisker in any_tapered(), share in 0.01..1.0_f64, force in 0.001..4.0_f64) {
        let bend = touched(&whisker, share, FRAC_PI_2, force);
        prop_assume!(bend.is_some());
        let bend = bend.unwrap();
        prop_assume!(stays(&whisker, &bend));
        is_found(&whisker, &bend)?;
    }

    #[test]
    fn a_touch_at_the_tip_is_found(whisker in any_tapered(), angle in FRAC_PI_2..3.1_f64, force in 0.001..3.0_f64) {
        let bend = touched(&whisker, 1.0, angle, force);
        prop_assume!(bend.is_some());
        let bend = bend.unwrap();
        prop_assume!(stays(&whisker, &bend));
        is_found(&whisker, &bend)?;
    }

    #[test]
    fn the_two_kinds_meet_where_the_force_is_square_at_the_tip(
        whisker in any_tapered(), off in -1e-3..1e-3_f64, force in 0.001..3.0_f64,
    ) {
        let bend = touched(&whisker, 1.0 + off.min(0.0), FRAC_PI_2 + off.max(0.0), force);
        prop_assume!(bend.is_some_and(|bend| stays(&whisker, &bend)));
        is_found(&whisker, &bend.unwrap())?;
    }

    #[test]
    fn what_is_found_is_a_touch_without_friction_with_these_readings(
        whisker in any_tapered(), moment in 0.001..6.0_f64, shear in -14.0..60.0_f64,
    ) {
        let elastica = Elastica::new(&whisker);
        let base_angle = tip_moment(&whisker, moment) / whisker.hinge.stiffness;
        let shear = shear * tip_moment(&whisker, 1.0) / whisker.shaft.length;
        match locate(&elastica, base_angle, shear) {
            Ok(bend) => {
                prop_assert!((bend.base_angle / base_angle - 1.0).abs() < 1e-9);
                prop_assert!((bend.shear - shear).abs() < 1e-9 * bend.force);
                let angle = bend.force_direction - bend.tip_angle;
                let is_square = (angle - FRAC_PI_2).abs() < 1e-12;
                let is_at_tip = bend.contact_length >= whisker.shaft.length;
                prop_assert!(is_square && !is_at_tip || is_at_tip && angle > FRAC_PI_2 - 1e-12 && angle < PI, "{bend:?}");
            }
            Err(LocateError::NoSolution) => {
                // Less than all that stay.
                for bend in with_base_angle(&whisker, base_angle) {
                    prop_assert!(shear < bend.shear + 1e-6 * bend.force, "{bend:?}");
                }
            }
            Err(error) => panic!("{error}"),
        }
    }

    /// A platform that is turned away from what it swipes bends its whiskers by forces that would push an unbent one to the other side.
    #[test]
    fn a_touch_of_a_surface_in_any_direction_is_found(
        whisker in any_tapered(), moment in 0.02..2.5_f64, direction in FRAC_PI_2..4.0_f64,
    ) {
        let elastica = Elastica::new(&whisker);
        let base_angle = tip_moment(&whisker, moment) / whisker.hinge.stiffness;
        prop_assume!(base_angle < 0.3);
        let sideways = elastica.solve_tip(base_angle, 2.0, &elastica.straight()).unwrap();
        let bend = elastica.solve_tip(base_angle, direction, &sideways);
        // Without friction a force at the tip comes from before it.
        prop_assume!(bend.is_some_and(|bend| bend.force_direction - bend.tip_angle > FRAC_PI_2 && stays(&whisker, &bend)));
        is_found(&whisker, &bend.unwrap())?;
    }

    #[test]
    fn the_changes_of_a_touch_are_those_between_neighbours(
        whisker in any_tapered(), share in 0.1..2.0_f64, angle in 1.6..3.0_f64, force in 0.05..4.0_f64, side in prop_oneof![Just(1.0), Just(-1.0)],
    ) {
        let elastica = Elastica::new(&whisker);
        let angle = if share < 1.0 { FRAC_PI_2 } else { angle };
        let bend = touched(&whisker, share.min(1.0), side * angle, force);
        prop_assume!(bend.is_some_and(|bend| bend.contact_base.y.abs() > 1e-6));
        let bend = bend.unwrap();
        let found = elastica.changes(&bend).unwrap();
        let at = |off: f64, more: f64| {
            let (length, angle) = if share < 1.0 {
                (bend.contact_length * (1.0 - off), side * angle)
            } else {
                (bend.contact_length, side * (angle + off))
            };
            elastica.under(length, angle, bend.force * (1.0 + more)).unwrap()
        };
        for other in [at(1e-5, 0.0), at(0.0, 1e-5)] {
            let expected = found * Vector2::new(other.base_angle - bend.base_angle, other.shear - bend.shear);
            let moved = other.contact_base - bend.contact_base;
            prop_assert!((expected.fixed_rows::<2>(0) - moved).norm() < 1e-8 * whisker.shaft.length, "{expected} {moved}");
            prop_assert!((expected.z - (other.force_direction - bend.force_direction)).abs() < 1e-8, "{expected}");
        }
    }

    /// Wherever the search begins, it finds the same.
    #[test]
    fn a_guess_does_no_harm(
        whisker in any_tapered(), moment in 0.001..3.0_f64, shear in 0.0..20.0_f64, share in 0.05..2.0_f64,
        angle in FRAC_PI_2..3.0_f64, force in 0.01..3.0_f64, side in prop_oneof![Just(1.0), Just(-1.0)],
    ) {
        let elastica = Elastica::new(&whisker);
        let angle = if share < 1.0 { FRAC_PI_2 } else { angle };
        let guess = touched(&whisker, share.min(1.0), side * angle, force);
        prop_assume!(guess.is_some());
        let base_angle = tip_moment(&whisker, moment) / whisker.hinge.stiffness;
        let shear = shear * tip_moment(&whisker, 1.0) / whisker.shaft.length;
        let warm = elastica.locate(base_angle, shear, &guess.unwrap());
        match (locate(&elastica, base_angle, shear), warm) {
            (Ok(cold), Ok(warm)) => {
                prop_assert!((cold.tip_base - warm.tip_base).norm() < 1e-6 * whisker.shaft.length, "{cold:?} {warm:?}");
            }
            (cold, warm) => prop_assert!(cold.is_err() && warm.is_err(), "{cold:?} {warm:?}"),
        }
    }

    #[test]
    fn the_mirror_image_is_found_on_the_other_side(whisker in any(), share in 0.1..1.0_f64, force in 0.01..3.0_f64) {
        let elastica = Elastica::new(&whisker);
        let bend = touched(&whisker, share, FRAC_PI_2, force);
        prop_assume!(bend.is_some());
        let bend = bend.unwrap();
        let [left, right] = [1.0, -1.0].map(|side| locate(&elastica, side * bend.base_angle, side * bend.shear));
        prop_assert_eq!(left.map(|bend| bend.mirrored()), right);
    }
}

#[test]
fn without_readings_nothing_touches_and_without_numbers_nothing_is_said() {
    let elastica = Elastica::new(&vibrissa_runtime::rig::Rig::default().whiskers[0]);
    assert_eq!(locate(&elastica, 0.0, 0.0), Err(LocateError::NoContact));
    for (base_angle, shear) in [(f64::NAN, 1e-3), (1e-4, f64::NAN), (f64::INFINITY, 0.0), (1e-4, f64::NEG_INFINITY)] {
        assert_eq!(locate(&elastica, base_angle, shear), Err(LocateError::NotFinite));
    }
}

#[test]
fn readings_that_no_touch_has_are_told_from_those_of_one() {
    let whisker = vibrissa_runtime::rig::Rig::default().whiskers.remove(1);
    let elastica = Elastica::new(&whisker);
    // A force at the very base bends nothing.
    assert_eq!(locate(&elastica, 0.0, 1e-3), Err(LocateError::NoSolution));
    // A shaft that hardly bends cannot lean against a force to the other side.
    assert_eq!(locate(&elastica, 1e-6, -1e-3), Err(LocateError::NoSolution));
    // Absurd readings are answered too.
    for (base_angle, shear) in [(1e300, 1e-3), (1e-300, -1e300), (-3e-4, 1e300), (1e3, 1.0)] {
        assert!(locate(&elastica, base_angle, shear).is_err());
    }
}

/// What the simulator's chain feels at its base is what an elastica feels that is touched some hundredths of a millimetre off.
#[test]
fn the_tip_of_a_chain_is_located_the_better_the_more_links_it_has() {
    let mut whisker = vibrissa_runtime::rig::Rig::default().whiskers.remove(1);
    let elastica = Elastica::new(&whisker);
    for (direction, base_angle) in [(2.88, 1e-4), (2.88, 3e-4), (2.4, 3e-4), (2.0, 1e-4)] {
        let bend = elastica.solve_tip(base_angle, direction, &elastica.straight()).unwrap();
        for (links, off) in [(16, 8e-5), (32, 2e-5), (64, 5e-6)] {
            whisker.shaft.links = links;
            let chain = ShaftChain::new(&whisker);
            let near = Equilibrium { force: bend.force, tip_angle: bend.tip_angle, ..chain.at_rest() };
            let solution = chain.solve(base_angle, direction, &near).unwrap();
            let found = locate(&elastica, base_angle, solution.force * (direction - base_angle).sin()).unwrap();
            let error = (found.contact_base - solution.tip_base).norm();
            assert!(found.contact_length >= whisker.shaft.length && error < off, "{direction} {base_angle}: {error} m");
        }
    }
}
