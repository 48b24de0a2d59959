//! The laws for going along surfaces.

use std::f64::consts::FRAC_PI_2;

use vibrissa_runtime::geometry::{Pose, Vector2, rotate, unit};
use vibrissa_runtime::machine::{Action, Mover, Senses, Turn, WhiskerVector};

use super::felt::{Felt, Whisker, swiping};
use super::law::{commanded, is_near, machine};

#[test]
fn swiping_goes_along_the_surface_nearer_when_bent_too_little_and_off_when_bent_too_much() {
    let law = "do swipe(w, 300 urad, 50 mm/s)";
    for whisker in [0, 1] {
        let off = |bend| {
            let (mover, along, speed, turn) = commanded(whisker, law, &swiping(whisker, bend));
            assert_eq!((mover, speed, turn), (Mover::Whisker(whisker), 0.05, Turn::Rate(0.0)));
            // Away from the object, which is on the whisker's side.
            -along.y * Felt::side(whisker)
        };
        assert!(off(1.0).abs() < 1e-12 && off(0.6) < -0.1 && off(1.4) > 0.1);
        let (_, along, ..) = commanded(whisker, law, &swiping(whisker, 1.0));
        assert!(is_near(along, Vector2::new(1.0, 0.0)));
        let mut unready = swiping(whisker, 1.0);
        unready.whiskers[whisker].ready = false;
        assert_eq!(machine(whisker, law).tick(&mut unready).action, Action::Hold);
    }
}

#[test]
fn a_whisker_that_is_hardly_bent_gets_on_along_the_surface() {
    for whisker in [0, 1] {
        let (_, along, ..) = commanded(whisker, "do swipe(w, 300 urad, 50 mm/s)", &swiping(whisker, 0.1));
        assert!(along.normalize().x > 0.4, "{along}");
    }
}

#[test]
fn a_whisker_follows_a_surface_that_it_does_not_feel_yet_and_comes_nearer() {
    for whisker in [0, 1] {
        let law = "do follow(w, direction(0 deg), 300 urad * w.side, 50 mm/s, 0 deg)";
        let (mover, along, speed, turn) = commanded(whisker, law, &Felt::at(Pose::default()));
        assert_eq!((mover, speed, turn), (Mover::Whisker(whisker), 0.05, Turn::Rate(0.0)));
        assert!(along.x > 0.0 && along.y * Felt::side(whisker) > 0.0);
    }
}

#[test]
fn a_tilt_turns_the_body_towards_the_object() {
    for whisker in [0, 1] {
        let (.., turn) = commanded(whisker, "do swipe_tilted(w, 300 urad, 50 mm/s, 10 deg)", &swiping(whisker, 1.0));
        let Turn::Rate(rate) = turn else { panic!() };
        assert!(rate * Felt::side(whisker) > 0.0);
    }
}

#[test]
fn the_body_turns_as_fast_as_its_speed_bears_and_no_faster() {
    let felt = Felt { body: Pose { heading: 2.0, ..Pose::default() }, ..swiping(0, 1.0) };
    for (speed, limit) in [(0.01, 0.01 / 0.06), (0.03, 0.5), (0.1, 45_f64.to_radians())] {
        let (.., turn) = commanded(0, &format!("do swipe(w, 300 urad, {speed:?} m/s)"), &felt);
        let Turn::Rate(rate) = turn else { panic!() };
        assert!((rate + limit).abs() < 1e-9, "{rate} {limit}");
    }
}

#[test]
fn between_two_walls_the_platform_goes_to_the_side_that_bends_less() {
    let mut felt = swiping(0, 1.0);
    felt.whiskers[1] = swiping(1, 1.0).whiskers[1];
    let law = "do keep_centre(w, v, 300 urad, 50 mm/s)";
    let (mover, along, speed, turn) = commanded(0, law, &felt);
    assert_eq!((mover, speed, turn), (Mover::Body, 0.05, Turn::Rate(0.0)));
    assert!(is_near(along, Vector2::new(1.0, 0.0)));
    // The right whisker is bent by half a target more than the left: to the left, by a quarter.
    felt.whiskers[0].base_angle *= 1.5;
    assert!(is_near(commanded(0, law, &felt).1, Vector2::new(1.0, 0.25)));
    felt.whiskers[0].base_angle *= 9.0;
    assert!(is_near(commanded(0, law, &felt).1, Vector2::new(1.0, 0.5)), "by half at most");
    // Walls that turn to the left, one by 10 deg and the other by 20 deg.
    felt.whiskers[0] = Whisker { tangent: unit(0.2), ..swiping(0, 1.0).whiskers[0] };
    felt.whiskers[1].tangent = unit(0.4);
    let (_, along, _, turn) = commanded(0, law, &felt);
    // As slowly as `swipe`, with a gain of 2 Hz.
    let Turn::Rate(rate) = turn else { panic!() };
    assert!(is_near(along, unit(0.3)) && (rate - 0.6).abs() < 1e-9, "{rate}");
    felt.whiskers[0].ready = false;
    assert_eq!(machine(0, law).tick(&mut felt).action, Action::Hold);
}

#[test]
fn around_an_edge_the_tip_of_a_whisker_that_is_bent_to_the_target_stays_in_place() {
    for whisker in [0, 1] {
        let felt = swiping(whisker, 1.0);
        let (mover, along, speed, turn) = commanded(whisker, "do go_around_edge(w, 300 urad, 50 mm/s)", &felt);
        let Turn::Rate(rate) = turn else { panic!() };
        assert_eq!((mover, speed), (Mover::Body, 0.05));
        assert!(rate * Felt::side(whisker) > 0.0, "towards the wall that turns away");
        let arm = felt.whisker_vector(whisker, WhiskerVector::Tip) - felt.body.position.coords;
        assert!((speed * along.normalize() + rate * rotate(arm, FRAC_PI_2)).norm() < 1e-9);
    }
}

#[test]
fn a_whisker_that_the_next_wall_bends_the_wrong_way_is_freed_straight_on() {
    for whisker in [0, 1] {
        let (mover, along, speed, turn) =
            commanded(whisker, "do go_around_edge(w, 300 urad, 50 mm/s)", &swiping(whisker, -0.3));
        assert_eq!((mover, speed, turn), (Mover::Body, 0.05, Turn::Rate(0.0)));
        assert!(is_near(along.normalize(), Vector2::new(1.0, 0.0)));
    }
}
