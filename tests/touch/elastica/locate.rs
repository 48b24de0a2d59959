//! Where a whisker is touched follows from the moment and the shear at its base.

use std::f64::consts::{FRAC_PI_2, PI};

use proptest::prelude::*;
use vibrissa::mechanics::{Bend, Elastica, Equilibrium, LocateError, ShaftChain};
use vibrissa::rig::Whisker;

use crate::elastica::whisker::{any, any_tapered, cut, tip_moment};

/// A bend under a force at a share of the length, at an angle from the shaft there, in units of `EI / c²` for the length
/// `c`, of as much less as the shaft tapers.
fn touched(whisker: &Whisker, share: f64, angle: f64, force: f64) -> Option<Bend> {
    let shaft = cut(whisker, share).shaft;
    let force = force * shaft.tip_stiffness() / shaft.length.powi(2);
    let bend = Elastica::new(whisker).under(share * whisker.shaft.length, angle, force)?;
    (bend.base_angle.abs() < 0.5).then_some(bend)
}

/// Whether a bend is one that a force makes and keeps: turning the force along with the shaft where it is, by a little, turns it
/// against the base the same way. Beyond that a shaft springs over.
fn stays(whisker: &Whisker, bend: &Bend) -> bool {
    let direction = |turn: f64| {
        let angle = bend.force_direction - bend.tip_angle + turn;
        Elastica::new(whisker).under(bend.contact_length, angle, bend.force).map(|bend| bend.force_direction)
    };
    direction(1e-5) > direction(-1e-5)
}

fn locate(elastica: &Elastica, base_angle: f64, shear: f64) -> Result<Bend, LocateError> {
    elastica.locate(base_angle, shear, &elastica.straight())
}

fn is_found(whisker: &Whisker, bend: &Bend) -> Result<(), TestCaseError> {
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
        whisker in any_tapered(), moment in 0.001..6.0_f64, shear in -1.0..60.0_f64,
    ) {
        let elastica = Elastica::new(&whisker);
        let base_angle = tip_moment(&whisker, moment) / whisker.hinge.stiffness;
        let unit = tip_moment(&whisker, 1.0) / whisker.shaft.length;
        let shear = shear * unit;
        match locate(&elastica, base_angle, shear) {
            Ok(bend) => {
                prop_assert!((bend.base_angle / base_angle - 1.0).abs() < 1e-9);
                prop_assert!((bend.shear - shear).abs() < 1e-9 * bend.force);
                let angle = bend.force_direction - bend.tip_angle;
                let is_square = (angle - FRAC_PI_2).abs() < 1e-12;
                let is_at_tip = bend.contact_length >= whisker.shaft.length;
                prop_assert!(is_square && !is_at_tip || is_at_tip && angle > FRAC_PI_2 - 1e-12 && angle < PI, "{bend:?}");
            }
            Err(LocateError::NoSolution { nearest }) => {
                prop_assert!((nearest.base_angle / base_angle - 1.0).abs() < 1e-9, "{nearest:?}");
                prop_assert!(nearest.shear > shear && stays(&whisker, &nearest), "{nearest:?}");
                // At the limit of what stays: a little less shear is too little.
                let limit = 1e-3 * (1.0 + moment * moment) * unit;
                prop_assert!(locate(&elastica, base_angle, nearest.shear + limit).is_ok(), "{nearest:?}");
                prop_assert!(locate(&elastica, base_angle, nearest.shear - limit).is_err(), "{nearest:?}");
            }
            Err(error) => panic!("{error}"),
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
    let elastica = Elastica::new(&vibrissa::rig::Rig::default().whiskers[0]);
    assert_eq!(locate(&elastica, 0.0, 0.0), Err(LocateError::NoContact));
    for (base_angle, shear) in [(f64::NAN, 1e-3), (1e-4, f64::NAN), (f64::INFINITY, 0.0), (1e-4, f64::NEG_INFINITY)] {
        assert_eq!(locate(&elastica, base_angle, shear), Err(LocateError::NotFinite));
    }
}

#[test]
fn readings_that_no_touch_has_are_told_from_those_of_one() {
    let whisker = vibrissa::rig::Rig::default().whiskers.remove(1);
    let elastica = Elastica::new(&whisker);
    let nearest = |base_angle, shear| match locate(&elastica, base_angle, shear) {
        Err(LocateError::NoSolution { nearest }) => nearest,
        other => panic!("{base_angle} {shear}: {other:?}"),
    };
    // A force at the very base bends nothing.
    assert_eq!(nearest(0.0, 1e-3), elastica.straight());
    // A shaft that hardly bends cannot lean against a force to the other side; the nearest is one at Euler's load.
    let buckled = nearest(1e-6, -1e-3);
    let unit = whisker.shaft.bending_stiffness() / whisker.shaft.length.powi(2);
    assert!((buckled.force / unit / (FRAC_PI_2 * FRAC_PI_2) - 1.0).abs() < 1e-2, "{buckled:?}");
    assert!(buckled.contact_length >= whisker.shaft.length && buckled.shear.abs() < 1e-3 * buckled.force);
    // Absurd readings are answered too.
    for (base_angle, shear) in [(1e300, 1e-3), (1e-300, -1e300), (-3e-4, 1e300), (1e3, 1.0)] {
        assert!(locate(&elastica, base_angle, shear).is_err());
    }
}

/// What the simulator's chain feels at its base is what an elastica feels that is touched some hundredths of a millimetre off.
#[test]
fn the_tip_of_a_chain_is_located_the_better_the_more_links_it_has() {
    let mut whisker = vibrissa::rig::Rig::default().whiskers.remove(1);
    let elastica = Elastica::new(&whisker);
    for (direction, base_angle) in [(2.88, 1e-4), (2.88, 3e-4), (2.4, 3e-4), (2.0, 1e-4)] {
        let bend = elastica.solve_tip(base_angle, direction, &elastica.straight()).unwrap();
        for (links, off) in [(16, 8e-5), (32, 2e-5), (64, 5e-6)] {
            whisker.shaft.links = links;
            let chain = ShaftChain::new(&whisker);
            let near = Equilibrium { force: bend.force, tip_angle: bend.tip_angle, ..chain.straight() };
            let solution = chain.solve(base_angle, direction, &near).unwrap();
            let found = locate(&elastica, base_angle, solution.force * (direction - base_angle).sin()).unwrap();
            let error = (found.contact_base - solution.tip_base).norm();
            assert!(found.contact_length >= whisker.shaft.length && error < off, "{direction} {base_angle}: {error} m");
        }
    }
}
