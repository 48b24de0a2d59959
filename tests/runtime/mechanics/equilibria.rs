//! What holds of every equilibrium.

use std::f64::consts::{FRAC_PI_2, PI};

use nalgebra::Vector4;
use proptest::prelude::*;
use vibrissa::geometry::unit;
use vibrissa_runtime::mechanics::{Elastica, ShaftShape};
use vibrissa_runtime::rig::Whisker;

use crate::mechanics::whisker::{any_tapered, cut, moment_unit, tip_moment};

/// Whiskers with a force that bends them: at a share of the length, at an angle from the shaft there, a force in units of
/// `EI / c²` for the length `c` to where it is, of as much less as the shaft tapers.
fn any_bend() -> impl Strategy<Value = (Whisker, ShaftShape)> {
    (any_tapered(), prop_oneof![Just(1.0), 0.05..1.0_f64], FRAC_PI_2..2.9_f64, 0.01..5.0_f64).prop_filter_map(
        "not to one side, or twisted at the base",
        |(whisker, share, angle, force)| {
            let shaft = cut(&whisker, share).shaft;
            let force = force * shaft.tip_stiffness() / shaft.length.powi(2);
            let bend = Elastica::new(&whisker).under(share * whisker.shaft.length, angle, force)?;
            (bend.base_angle < 1.0).then_some((whisker, bend))
        },
    )
}

/// The base and the shaft up to the force, integrated from the base by the classical Runge-Kutta method: direction, place
/// and energy (rad, m, m, J) where the force is.
fn integrated(whisker: &Whisker, bend: &ShaftShape) -> Vector4<f64> {
    let force = bend.force * unit(bend.force_direction);
    let slope = |s: f64, state: Vector4<f64>| {
        let thickness = whisker.shaft.radius_at(s / whisker.shaft.length) / whisker.shaft.radius;
        let stiffness = whisker.shaft.bending_stiffness() * thickness.powi(4);
        let place = nalgebra::Vector2::new(state.y, state.z);
        let moment = (bend.contact_base - place).perp(&force);
        Vector4::new(moment / stiffness, state.x.cos(), state.x.sin(), 0.5 * moment * moment / stiffness)
    };
    let step = bend.contact_length / 2000.0;
    let hinge_energy = 0.5 * whisker.hinge.stiffness * bend.base_angle.powi(2);
    let mut state = Vector4::new(bend.base_angle, 0.0, 0.0, hinge_energy);
    for index in 0..2000 {
        let s = f64::from(index) * step;
        let a = slope(s, state);
        let b = slope(s + 0.5 * step, state + 0.5 * step * a);
        let c = slope(s + 0.5 * step, state + 0.5 * step * b);
        let d = slope(s + step, state + step * c);
        state += step / 6.0 * (a + 2.0 * (b + c) + d);
    }
    state
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn the_base_balances_the_force_and_the_shaft_leads_to_it((whisker, bend) in any_bend()) {
        let length = whisker.shaft.length;
        let force = bend.force * unit(bend.force_direction);
        let moment = whisker.hinge.stiffness * bend.base_angle;
        prop_assert!((bend.contact_base.perp(&force) - moment).abs() < 1e-9 * moment);
        prop_assert!((force.dot(&unit(bend.base_angle)) - bend.axial).abs() < 1e-9 * bend.force);
        prop_assert!((force.dot(&unit(bend.base_angle + FRAC_PI_2)) - bend.shear).abs() < 1e-9 * bend.force);
        let end = integrated(&whisker, &bend);
        prop_assert!((end.x - bend.tip_angle).abs() < 1e-8);
        prop_assert!((end.fixed_rows::<2>(1) - bend.contact_base).norm() < 1e-8 * length);
        let beyond = (length - bend.contact_length) * unit(bend.tip_angle);
        prop_assert!((bend.contact_base + beyond - bend.tip_base).norm() < 1e-12);
    }

    /// The work of a force goes into the springs.
    #[test]
    fn energy_changes_by_force_times_way((whisker, bend) in any_bend(), more in 1e-4..1e-3_f64, turn in -1e-3..1e-3_f64) {
        let elastica = Elastica::new(&whisker);
        let near = |sign: f64| {
            let force_angle = bend.force_direction - bend.tip_angle + sign * turn;
            elastica.under(bend.contact_length, force_angle, bend.force * (1.0 + sign * more))
        };
        let (Some(before), Some(after)) = (near(-1.0), near(1.0)) else { return Ok(()) };
        let gain = integrated(&whisker, &after).w - integrated(&whisker, &before).w;
        let way = after.contact_base - before.contact_base;
        let work = way.dot(&(bend.force * unit(bend.force_direction)));
        prop_assert!((gain - work).abs() < 1e-5 * bend.force * way.norm(), "{gain} {work}");
    }

    /// Newton's method finds again what follows from a force without being solved for.
    #[test]
    fn what_a_force_makes_is_found_from_its_moment_and_direction((whisker, bend) in any_bend()) {
        let elastica = Elastica::new(&whisker);
        let near = elastica.under(bend.contact_length, bend.force_direction - bend.tip_angle, 0.9 * bend.force).unwrap();
        // Where a force pushes a bent shaft back past its base, a straight one would bend to the other side.
        let guesses = if bend.force_direction < PI { vec![near, elastica.straight()] } else { vec![near] };
        for guess in guesses {
            let again = elastica.solve_at(bend.contact_length, bend.base_angle, bend.force_direction, &guess);
            prop_assert!(again.is_some());
            let again = again.unwrap();
            prop_assert!((again.tip_base - bend.tip_base).norm() < 1e-9 * whisker.shaft.length, "{bend:?} {again:?}");
        }
    }

    #[test]
    fn the_mirror_image_is_in_balance_too(whisker in any_tapered(), moment in 0.01..3.0_f64, direction in 0.8..2.9_f64) {
        let elastica = Elastica::new(&whisker);
        let (length, base_angle) = (whisker.shaft.length, tip_moment(&whisker, moment) / whisker.hinge.stiffness);
        let [left, right] = [1.0, -1.0].map(|side| {
            elastica.solve_tip(side * base_angle, side * direction, &elastica.straight()).unwrap()
        });
        prop_assert_eq!(right, left.mirrored());
        let under = elastica.under(length, left.force_direction - left.tip_angle, left.force).unwrap();
        let mirrored = elastica.under(length, left.tip_angle - left.force_direction, left.force).unwrap();
        prop_assert_eq!(mirrored, under.mirrored());
    }

    /// Lengths and stiffnesses have no scale of their own.
    #[test]
    fn whiskers_of_any_size_bend_alike(
        (whisker, bend) in any_bend(), longer in 0.2..5.0_f64, stiffer in 0.2..5.0_f64,
    ) {
        let mut other = whisker.clone();
        other.shaft.length *= longer;
        other.shaft.young_modulus *= stiffer;
        other.hinge.stiffness *= moment_unit(&other) / moment_unit(&whisker);
        let force = bend.force * stiffer / longer.powi(2);
        let angle = bend.force_direction - bend.tip_angle;
        let like = Elastica::new(&other).under(bend.contact_length * longer, angle, force).unwrap();
        prop_assert!((like.tip_base / longer - bend.tip_base).norm() < 1e-9 * whisker.shaft.length);
        prop_assert!((like.base_angle / bend.base_angle - 1.0).abs() < 1e-9);
        prop_assert!((like.shear - bend.shear * stiffer / longer.powi(2)).abs() < 1e-9 * force);
    }

    /// Beyond the force the shaft is straight, as if it were not there.
    #[test]
    fn a_force_on_the_shaft_bends_it_as_one_at_the_tip_of_a_shorter_one((whisker, bend) in any_bend()) {
        let shorter = cut(&whisker, bend.contact_length / whisker.shaft.length);
        let angle = bend.force_direction - bend.tip_angle;
        let other = Elastica::new(&shorter).under(bend.contact_length, angle, bend.force).unwrap();
        prop_assert!((other.tip_base - bend.contact_base).norm() < 1e-9 * whisker.shaft.length);
        prop_assert!((other.base_angle / bend.base_angle - 1.0).abs() < 1e-9);
    }
}
