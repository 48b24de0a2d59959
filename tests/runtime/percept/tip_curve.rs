//! The whisker's mechanics against the exact elastica.

use std::f64::consts::{FRAC_PI_2, PI};

use nalgebra::Vector2;
use proptest::prelude::*;
use vibrissa_runtime::mechanics::{Equilibrium, ShaftChain};
use vibrissa_runtime::percept::{TipCurve, TipCurveError};
use vibrissa_runtime::rig::{Rig, Whisker};

/// Direction (rad) of the contact force on the reference whisker.
const FORCE: f64 = 165.0 * PI / 180.0;
/// The target base angle (rad) of the baseline.
const TARGET: f64 = 3e-4;

fn left() -> Whisker {
    Rig::default().whiskers.remove(1)
}

fn with_links(links: usize) -> Whisker {
    let mut whisker = left();
    whisker.shaft.links = links;
    whisker
}

/// The chain's equilibrium at `base_angle`, followed from the straight chain in small steps.
fn chain(whisker: &Whisker, base_angle: f64, force_direction: f64) -> Equilibrium {
    let chain = ShaftChain::new(whisker);
    let shaft = &whisker.shaft;
    let steps = 40;
    let mut before = chain.at_rest();
    let mut solution = before;
    for index in 1..=steps {
        let angle = base_angle * f64::from(index) / f64::from(steps);
        let mut guess = solution;
        if index == 1 {
            guess.force = angle * whisker.hinge.stiffness / (shaft.length * force_direction.sin());
            guess.tip_angle = angle * whisker.hinge.stiffness * shaft.length / (2.0 * shaft.bending_stiffness());
        } else {
            guess.force += solution.force - before.force;
            guess.tip_angle += solution.tip_angle - before.tip_angle;
        }
        before = solution;
        solution = chain.solve(angle, force_direction, &guess).unwrap();
    }
    solution
}

/// The end of the exact elastica, θ'' = F/EI sin(θ − φ), from θ(0) = `base_angle` and the curvature there, which the base
/// moment gives, for a force `force`: its curvature at the tip, which must vanish, and the tip's place. Fourth-order
/// Runge-Kutta in 2000 steps.
fn elastica(whisker: &Whisker, base_angle: f64, force: f64, force_direction: f64) -> (f64, Vector2<f64>) {
    let shaft = &whisker.shaft;
    let stiffness = shaft.bending_stiffness();
    let slope = |state: [f64; 4]| {
        let [angle, curvature, ..] = state;
        [curvature, force / stiffness * (angle - force_direction).sin(), angle.cos(), angle.sin()]
    };
    let step = shaft.length / 2000.0;
    let add = |state: [f64; 4], by: f64, slope: [f64; 4]| std::array::from_fn(|i| state[i] + by * slope[i]);
    let mut state = [base_angle, whisker.hinge.stiffness * base_angle / stiffness, 0.0, 0.0];
    for _ in 0..2000 {
        let k1 = slope(state);
        let k2 = slope(add(state, 0.5 * step, k1));
        let k3 = slope(add(state, 0.5 * step, k2));
        let k4 = slope(add(state, step, k3));
        state = std::array::from_fn(|i| state[i] + step / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]));
    }
    (state[1], Vector2::new(state[2], state[3]))
}

/// The tip of the exact elastica: the force near `guess` that leaves the tip free of moment, by the secant method.
fn exact_tip(whisker: &Whisker, base_angle: f64, force_direction: f64, guess: f64) -> Vector2<f64> {
    let (mut a, mut b) = (0.99 * guess, 1.01 * guess);
    let mut at_a = elastica(whisker, base_angle, a, force_direction).0;
    for _ in 0..50 {
        let (at_b, tip) = elastica(whisker, base_angle, b, force_direction);
        if at_b.abs() < 1e-10 {
            return tip;
        }
        (a, b, at_a) = (b, b - at_b * (b - a) / (at_b - at_a), at_b);
    }
    panic!("the secant method did not settle");
}

fn chain_error(links: usize, base_angle: f64, force_direction: f64) -> f64 {
    let whisker = with_links(links);
    let solution = chain(&whisker, base_angle, force_direction);
    (solution.tip_base - exact_tip(&whisker, base_angle, force_direction, solution.force)).norm()
}

/// How far along a smooth surface the tip of the exact elastica is from the chain's, and the share by which its base moment
/// differs, when both are held against the same surface: one square to the force, through the chain's tip.
fn difference_on_a_surface(whisker: &Whisker, base_angle: f64, force_direction: f64) -> (f64, f64) {
    let solution = chain(whisker, base_angle, force_direction);
    let normal = Vector2::new(force_direction.cos(), force_direction.sin());
    let apart = |factor: f64| {
        exact_tip(whisker, factor * base_angle, force_direction, factor * solution.force) - solution.tip_base
    };
    // The base angle at which the exact tip is on the surface, by the secant method.
    let (mut a, mut b) = (0.999, 1.001);
    let mut off_at_a = apart(a).dot(&normal);
    for _ in 0..50 {
        let off_at_b = apart(b).dot(&normal);
        if off_at_b.abs() < 1e-12 {
            return (apart(b).norm(), (b - 1.0).abs());
        }
        (a, b, off_at_a) = (b, b - off_at_b * (b - a) / (off_at_b - off_at_a), off_at_b);
    }
    panic!("the secant method did not settle");
}

#[test]
fn sixteen_links_against_a_surface_are_within_hundredths_of_a_millimetre_of_the_elastica() {
    let whisker = left();
    for direction in [100.0_f64, 120.0, 140.0, 165.0].map(f64::to_radians) {
        for base_angle in [1e-4, 2e-4, TARGET] {
            let (tip, moment) = difference_on_a_surface(&whisker, base_angle, direction);
            assert!(tip < 2.5e-5, "{direction} rad, {base_angle} rad: {tip} m");
            assert!(moment < 2.5e-3, "{direction} rad, {base_angle} rad: {moment}");
        }
    }
}

#[test]
fn the_error_of_the_chain_falls_with_the_square_of_its_links() {
    let errors = [8, 16, 32, 64].map(|links| chain_error(links, TARGET, FORCE));
    for pair in errors.windows(2) {
        let order = (pair[0] / pair[1]).log2();
        assert!((order - 2.0).abs() < 0.1, "{errors:?}");
    }
}

#[test]
fn a_small_bend_is_that_of_a_cantilever() {
    let whisker = with_links(64);
    let shaft = &whisker.shaft;
    let (base_angle, across) = (1e-6, FRAC_PI_2);
    let solution = chain(&whisker, base_angle, across);
    let force = base_angle * whisker.hinge.stiffness / shaft.length;
    let deflection = force * shaft.length.powi(3) / (3.0 * shaft.bending_stiffness()) + base_angle * shaft.length;
    assert!((solution.tip_base.y / deflection - 1.0).abs() < 1e-3);
}

/// The angles of the links, from the root, that the moments of the tip force about all joints give.
fn angles_from_moments(whisker: &Whisker, solution: &Equilibrium, force_direction: f64) -> Vec<f64> {
    let length = whisker.shaft.link_length();
    let force = solution.force * Vector2::new(force_direction.cos(), force_direction.sin());
    let mut joint = Vector2::zeros();
    let mut angle = solution.base_angle;
    let stiffnesses: Vec<f64> = whisker.shaft.joint_stiffnesses().collect();
    stiffnesses
        .into_iter()
        .map(|stiffness| {
            angle += (solution.tip_base - joint).perp(&force) / stiffness;
            joint += length * Vector2::new(angle.cos(), angle.sin());
            angle
        })
        .collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn every_joint_is_in_balance(
        links in 2_usize..40, direction in 95.0..168.0_f64, moment in 0.05..2.0_f64, length in 0.03..0.2_f64,
        radius in 0.05e-3..0.4e-3_f64,
    ) {
        let mut whisker = with_links(links);
        (whisker.shaft.length, whisker.shaft.radius) = (length, radius);
        let base_angle = moment * whisker.shaft.bending_stiffness() / length / whisker.hinge.stiffness;
        let direction = direction.to_radians();
        let solution = chain(&whisker, base_angle, direction);
        let angles = angles_from_moments(&whisker, &solution, direction);
        prop_assert!((angles.last().unwrap() - solution.tip_angle).abs() < 1e-9);
        let link = whisker.shaft.link_length();
        let end: Vector2<f64> = angles.iter().map(|angle| link * Vector2::new(angle.cos(), angle.sin())).sum();
        prop_assert!((end - solution.tip_base).norm() < 1e-9 * length);
        let direction = Vector2::new(direction.cos(), direction.sin());
        let base_moment = solution.tip_base.perp(&(solution.force * direction));
        prop_assert!((base_moment / whisker.hinge.stiffness - base_angle).abs() < 1e-9 * base_angle);
    }

    #[test]
    fn the_derivatives_lead_newtons_method_home_from_a_poor_guess(off in -0.05..0.05_f64, stretch in 0.9..1.1_f64) {
        let whisker = left();
        let solution = chain(&whisker, TARGET, FORCE);
        let guess = Equilibrium { tip_angle: solution.tip_angle + off, force: solution.force * stretch, ..solution };
        let again = ShaftChain::new(&whisker).solve(TARGET, FORCE, &guess).unwrap();
        prop_assert!((again.tip_base - solution.tip_base).norm() < 1e-12);
    }
}

/// Where the tip touches at `base_angle`, without a table.
fn direct_contact(whisker: &Whisker, base_angle: f64) -> Vector2<f64> {
    let normal = Vector2::new(FORCE.cos(), FORCE.sin());
    chain(whisker, base_angle, FORCE).tip_base - whisker.shaft.radius * normal
}

/// The end of the model's range (rad): six times EI/L over the hinge's stiffness.
fn range(whisker: &Whisker) -> f64 {
    6.0 * whisker.shaft.bending_stiffness() / whisker.shaft.length / whisker.hinge.stiffness
}

#[test]
fn the_tip_models_table_is_within_a_micrometre_of_direct_solutions() {
    let whisker = left();
    let model = TipCurve::new(&whisker).unwrap();
    let mut worst: f64 = 0.0;
    for index in 1..=777 {
        let base_angle = range(&whisker) * f64::from(index) / 777.0;
        worst = worst.max((model.contact_base(base_angle) - direct_contact(&whisker, base_angle)).norm());
    }
    assert!(worst < 1e-6, "{worst} m");
}

#[test]
fn the_tip_model_is_the_same_for_both_whiskers_and_mirrored_for_the_other_bend() {
    let rig = Rig::default();
    let [right, left] = [0, 1].map(|index| TipCurve::new(&rig.whiskers[index]).unwrap());
    for index in 1..2000 {
        let base_angle = f64::from(index) * 1e-6;
        let contact = left.contact_base(base_angle);
        assert_eq!(contact, right.contact_base(base_angle));
        assert_eq!(Vector2::new(contact.x, -contact.y), left.contact_base(-base_angle));
    }
}

#[test]
fn the_contact_changes_sides_of_the_wire_at_zero_and_nothing_else_jumps() {
    let whisker = left();
    let model = TipCurve::new(&whisker).unwrap();
    let jump = model.contact_base(1e-12) - model.contact_base(-1e-12);
    assert!((jump.y + 2.0 * whisker.shaft.radius * FORCE.sin()).abs() < 1e-8 && jump.x.abs() < 1e-8, "{jump}");
    let step = 1e-7;
    for index in 0..20_000 {
        let base_angle = f64::from(index) * step;
        let (a, b) = (model.contact_base(base_angle), model.contact_base(base_angle + step));
        assert!((b - a).norm() < 2e-4 * whisker.shaft.length + 1e-12, "at {base_angle}");
    }
}

/// Friction turns the force on the tip as a whisker swept back by its angle more has it; only the spot of the tip that touches differs.
#[test]
fn friction_turns_the_force_as_sweeping_back_does() {
    for friction in [0.05_f64, 0.1, 0.3, 0.6] {
        let turn = friction.atan();
        let model = TipCurve::with_friction(&left(), friction).unwrap();
        let swept = Whisker { direction_body: left().direction_body + turn, ..left() };
        let like = TipCurve::new(&swept).unwrap();
        let spot = |direction: f64| -left().shaft.radius * Vector2::new(direction.cos(), direction.sin());
        let apart = spot(FORCE) - spot(FORCE - turn);
        for index in 1..=100 {
            let base_angle = range(&left()) * f64::from(index) / 100.0;
            let difference = model.contact_base(base_angle) - like.contact_base(base_angle);
            assert!((difference - apart).norm() < 1e-9, "{friction} at {base_angle} rad");
        }
    }
}

#[test]
fn the_tip_comes_nearer_the_more_the_whisker_bends() {
    let whisker = left();
    let model = TipCurve::new(&whisker).unwrap();
    let contacts: Vec<f64> =
        (0..=1000).map(|index| model.contact_base(range(&whisker) * f64::from(index) / 1000.0).x).collect();
    assert!(contacts.windows(2).all(|pair| pair[1] < pair[0]));
}

#[test]
fn beyond_the_range_the_tip_stays_and_no_number_gives_no_number() {
    let whisker = left();
    let model = TipCurve::new(&whisker).unwrap();
    let last = model.contact_base(range(&whisker));
    for base_angle in [1.001 * range(&whisker), 1.0, 1e9, f64::INFINITY] {
        assert!((model.contact_base(base_angle) - last).norm() < 1e-15);
        assert!((model.contact_base(-base_angle) - Vector2::new(last.x, -last.y)).norm() < 1e-15);
    }
    assert!(model.contact_base(f64::NAN).iter().all(|part| part.is_nan()));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    #[test]
    fn any_sensible_whisker_has_a_tip_model(
        length in 0.02..0.3_f64, radius in 0.03e-3..1e-3_f64, links in 4_usize..64, ratio in 20.0..1e6_f64,
        sweep in prop_oneof![5.0..90.0_f64, -90.0..-5.0_f64], side in prop_oneof![Just(1.0), Just(-1.0)],
    ) {
        let mut whisker = with_links(links);
        (whisker.shaft.length, whisker.shaft.radius) = (length, radius);
        whisker.hinge.stiffness = ratio * whisker.shaft.bending_stiffness() / length;
        whisker.direction_body = side * (90.0 + sweep).to_radians();
        let model = TipCurve::new(&whisker);
        prop_assert!(model.is_ok(), "{:?}", model.err());
        let straight = model.unwrap().contact_base(0.0);
        prop_assert!((straight.x - length).abs() <= 1.001 * radius);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    #[test]
    fn any_tapered_whisker_has_a_tip_model(
        taper in 0.05..1.0_f64, links in 4_usize..64, sweep in prop_oneof![5.0..90.0_f64, -90.0..-5.0_f64],
    ) {
        let mut whisker = with_links(links);
        whisker.shaft.tip_radius = Some(taper * whisker.shaft.radius);
        whisker.direction_body = (90.0 + sweep).to_radians();
        let model = TipCurve::new(&whisker);
        prop_assert!(model.is_ok(), "{:?}", model.err());
        let straight = model.unwrap().contact_base(0.0);
        prop_assert!((straight.x - whisker.shaft.length).abs() <= 1.001 * taper * whisker.shaft.radius);
    }
}

/// It may buckle either way.
#[test]
fn a_whisker_straight_across_the_platform_has_none_and_the_error_says_what_to_do() {
    for degrees in [90.0, -90.0, 94.0, 86.0_f64] {
        let whisker = Whisker { direction_body: degrees.to_radians(), ..left() };
        let error = TipCurve::new(&whisker).unwrap_err();
        assert!(matches!(&error, TipCurveError::HeadOn { .. }) && error.to_string().contains("sweep it"), "{error}");
    }
}

/// The body is turned until one that points forward trails by as much.
#[test]
fn whiskers_swept_forward_and_back_by_the_same_angle_have_the_same_model_with_any_friction() {
    for friction in [0.0, 0.1, 0.3] {
        let [back, forward] = [105.0, 75.0_f64].map(|degrees| {
            let whisker = Whisker { direction_body: degrees.to_radians(), ..left() };
            TipCurve::with_friction(&whisker, friction).unwrap()
        });
        for base_angle in [-5e-4, -1e-5, 0.0, 1e-4, 3e-4] {
            assert!((back.contact_base(base_angle) - forward.contact_base(base_angle)).norm() < 1e-12);
        }
    }
}

#[test]
fn the_spread_of_a_tip_is_that_of_surfaces_which_are_not_parallel_to_the_heading() {
    let model = TipCurve::new(&left()).unwrap();
    for base_angle in [5e-5, 1e-4, TARGET, 5e-4] {
        let contact = |turn: f64| {
            let (direction, radius) = (FORCE + turn, left().shaft.radius);
            let normal = Vector2::new(direction.cos(), direction.sin());
            chain(&left(), base_angle, direction).tip_base - radius * normal
        };
        let moved = |turn: f64| (contact(turn) - contact(0.0)).norm() / turn.abs() * 10_f64.to_radians();
        let (spread, small) = (model.deviation(base_angle, 0.0), 0.5_f64.to_radians());
        let near = f64::midpoint(moved(small), moved(-small));
        assert!((spread / near - 1.0).abs() < 0.03, "{base_angle}: {spread} {near}");
        // The nearer the surface is to head-on, the more a turn does.
        let far = 5_f64.to_radians();
        assert!(moved(-far) < spread && spread < moved(far), "{base_angle}: {} {spread} {}", moved(-far), moved(far));
    }
}

proptest! {
    #[test]
    fn the_spread_of_a_tip_grows_with_what_the_base_angle_may_be_off(base_angle in -1e-3..1e-3_f64, off in 1e-7..2e-6_f64) {
        let model = TipCurve::new(&left()).unwrap();
        let (still, spread) = (model.deviation(base_angle, 0.0), model.deviation(base_angle, off));
        prop_assert!((model.deviation(-base_angle, off) - spread).abs() <= f64::EPSILON * spread);
        let moved = (model.contact_base(base_angle + off) - model.contact_base(base_angle - off)).norm() / 2.0;
        // Where the base angle changes its sign the model has a bend.
        if base_angle.abs() > 2e-5 {
            prop_assert!((spread - still.hypot(moved)).abs() < 0.02 * spread, "{spread} {still} {moved}");
        }
    }
}

#[test]
fn a_whisker_that_is_not_bent_is_where_it_is_and_beyond_the_model_nothing_is_known() {
    let model = TipCurve::new(&left()).unwrap();
    // The sphere at its tip may be touched on any side.
    assert!(model.deviation(0.0, 0.0) <= left().shaft.radius);
    assert!(model.deviation(2e-3, 0.0).is_infinite());
    assert!(model.deviation(f64::NAN, 0.0).is_nan());
}
