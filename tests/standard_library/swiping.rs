//! The laws for going along surfaces.

use vibrissa::geometry::{Vector2, unit};
use vibrissa::machine::{Action, Mover, Turn};

use super::felt::{Felt, Whisker, swiping};
use super::law::{commanded, is_near, machine};

#[test]
fn swiping_goes_along_the_surface_nearer_when_bent_too_little_and_off_when_bent_too_much() {
    let law = "do swipe(w, 300 urad, 50 mm/s)";
    for whisker in [0, 1] {
        let off = |bend| {
            let (mover, along, speed, turn) = commanded(whisker, law, &swiping(whisker, bend));
            assert_eq!((mover, speed, turn), (Mover::Whisker(whisker), 0.05, Turn::Facing(0.0)));
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
fn a_tilt_turns_the_body_towards_the_object() {
    for whisker in [0, 1] {
        let (.., turn) = commanded(whisker, "do swipe_tilted(w, 300 urad, 50 mm/s, 10 deg)", &swiping(whisker, 1.0));
        let Turn::Facing(heading) = turn else { panic!() };
        assert!((heading - 10_f64.to_radians() * Felt::side(whisker)).abs() < 1e-12);
    }
}

#[test]
fn between_two_walls_the_platform_goes_to_the_side_that_bends_less() {
    let mut felt = swiping(0, 1.0);
    felt.whiskers[1] = swiping(1, 1.0).whiskers[1];
    let law = "do keep_centre(w, v, 300 urad, 50 mm/s)";
    let (mover, along, speed, turn) = commanded(0, law, &felt);
    assert_eq!((mover, speed, turn), (Mover::Body, 0.05, Turn::Facing(0.0)));
    assert!(is_near(along, Vector2::new(1.0, 0.0)));
    // The right whisker is bent by half a target more than the left: to the left, by a quarter.
    felt.whiskers[0].deflection *= 1.5;
    assert!(is_near(commanded(0, law, &felt).1, Vector2::new(1.0, 0.25)));
    felt.whiskers[0].deflection *= 9.0;
    assert!(is_near(commanded(0, law, &felt).1, Vector2::new(1.0, 0.5)), "by half at most");
    // Walls that turn to the left, one by 10 deg and the other by 20 deg.
    felt.whiskers[0] = Whisker { tangent: unit(0.2), ..swiping(0, 1.0).whiskers[0] };
    felt.whiskers[1].tangent = unit(0.4);
    let (_, along, _, turn) = commanded(0, law, &felt);
    let Turn::Facing(heading) = turn else { panic!() };
    assert!(is_near(along, unit(0.3)) && (heading - 0.3).abs() < 1e-12);
    felt.whiskers[0].ready = false;
    assert_eq!(machine(0, law).tick(&mut felt).action, Action::Hold);
}
