//! The laws for going round an edge.

use std::f64::consts::{FRAC_PI_2, PI};

use proptest::prelude::*;
use vibrissa_runtime::geometry::{Point2, Pose, Vector2, rotate, turn_between, unit};
use vibrissa_runtime::machine::{Mover, Turn};
use vibrissa_runtime::motion::Steering;
use vibrissa_runtime::rig::Rig;

use super::felt::{Felt, swiping};
use super::guard::holds;
use super::law::{commanded, is_near, machine, place, unit_vector};

#[test]
fn detaching_lifts_the_whisker_off_its_surface_without_turning() {
    for whisker in [0, 1] {
        let law = "do detach(w, w.contour.tangent, 40 mm/s)";
        let (mover, along, speed, turn) = commanded(whisker, law, &swiping(whisker, 1.0));
        assert_eq!((mover, speed, turn), (Mover::Whisker(whisker), 0.04, Turn::Rate(0.0)));
        assert!(is_near(along, Vector2::new(0.0, -Felt::side(whisker))));
    }
}

#[test]
fn whisking_back_goes_straight_from_the_contact_to_the_edge() {
    let law = "do whisk_back(w, position(0.1 m, 0.2 m), position(0.1 m, 0.19 m), 60 urad, 40 mm/s)";
    let (mover, along, speed, turn) = commanded(0, law, &swiping(0, 0.2));
    assert_eq!((mover, speed, turn), (Mover::Whisker(0), 0.04, Turn::Rate(0.0)));
    assert!(is_near(along.normalize(), Vector2::new(0.0, -1.0)));
}

#[test]
fn an_approach_goes_ahead_and_as_much_towards_the_object() {
    for whisker in [0, 1] {
        let law = "do approach(w, direction(0 deg), 40 mm/s)";
        let (mover, along, speed, turn) = commanded(whisker, law, &Felt::at(Pose::default()));
        assert_eq!((mover, speed, turn), (Mover::Whisker(whisker), 0.04, Turn::Rate(0.0)));
        assert!(is_near(along, Vector2::new(1.0, Felt::side(whisker))));
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    #[test]
    fn a_corner_is_where_two_surfaces_meet_and_not_far_from_its_edge(
        (x, y) in (-1.0..1.0_f64, -1.0..1.0_f64), way in -PI..PI, around in 0.5..2.6_f64, short in -0.02..0.02_f64, beyond in 0.0..0.02_f64,
    ) {
        let (true_corner, way, surface) = (Point2::new(x, y), unit(way), unit(way - around));
        let (edge, contact) = (true_corner - short * way, true_corner + beyond * surface);
        let near = true_corner + (short.clamp(-0.006, 0.006) - short) * way;
        let [edge, contact, near] = [edge, contact, near].map(place);
        let guard = format!(
            "is_near(corner({edge}, {}, {contact}, {}, 6 mm), {near}, 0.001 mm)", unit_vector(way), unit_vector(surface)
        );
        prop_assert!(holds(&guard, 0, &Felt::at(Pose::default())));
    }
}

/// The platform after a law has been done for some seconds by the reference rig's steering, with nothing in its way.
fn after(whisker: usize, law: &str, body: Pose, seconds: u32) -> Felt {
    let rig = Rig::default();
    let (mut machine, mut steering) = (machine(whisker, law), Steering::new(&rig, &[Some(0), Some(1)]));
    let mut felt = Felt::at(body);
    for _ in 0..30 * seconds {
        let action = machine.tick(&mut felt).action;
        let command = steering.command(&action, felt.body);
        felt.body.position += command.velocity_world / 30.0;
        felt.body.heading += command.yaw_rate / 30.0;
    }
    felt
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    /// The edge of an object on the whisker's side, the way along x up to it; for a whisker on the left all in a mirror.
    #[test]
    fn the_unbent_tip_comes_to_where_the_steps_of_retrieval_want_it(
        whisker in 0_usize..2, heading in -1.0..1.0_f64, x in -0.1..0.1_f64, y in -0.1..0.1_f64, around in 0.0..PI, step in 0_usize..3,
    ) {
        let side = Felt::side(whisker);
        // Where and along what the new surface goes from the edge: turned towards the object.
        let surface = unit(side * around);
        let off = rotate(surface, -FRAC_PI_2 * side);
        let edge = Point2::new(0.3, 0.4);
        let (at, new) = (place(edge), unit_vector(surface));
        let tilt = side * 20_f64.to_radians();
        let (law, place, heading_due) = match step {
            0 => (
                format!("do return_to_edge(w, {at}, direction(0 deg), 20 mm, 50 mm/s)"),
                edge - 0.02 * side * Vector2::new(0.0, 1.0),
                0.0,
            ),
            1 => (
                format!("do reach_around(w, {at}, direction(0 deg), 10 mm, {around:?} rad, 20 deg, 50 mm/s)"),
                edge + 0.01 * surface,
                side * around + tilt,
            ),
            _ => (
                format!("do reposition(w, {at}, {new}, 20 mm, 20 deg, 50 mm/s)"),
                edge + 0.02 * off - 0.012 * surface,
                side * around + tilt,
            ),
        };
        let felt = after(whisker, &law, Pose { position: Point2::new(0.2 + x, 0.4 + y), heading }, 20);
        prop_assert!((felt.tip_at_rest(whisker) - place).norm() < 1e-3, "{} {}", felt.tip_at_rest(whisker), place);
        prop_assert!(turn_between(felt.body.heading, heading_due).abs() < 0.01, "{} {heading_due}", felt.body.heading);
    }
}
