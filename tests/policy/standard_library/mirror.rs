//! A left whisker is a right one in a mirror.

use std::f64::consts::PI;

use proptest::prelude::*;
use vibrissa_runtime::geometry::{Point2, Pose, Vector2, turn_between, unit};
use vibrissa_runtime::machine::{Mover, Turn};

use super::felt::{Felt, Whisker, flipped};
use super::law::{commanded, is_near, place, unit_vector};

prop_compose! {
    /// Both whiskers touch, and the walls do not go opposite ways: else some laws keep the last command.
    fn felt()(
        (x, y, heading) in (-1.0..1.0_f64, -1.0..1.0_f64, -PI..PI),
        bends in [3e-5..6e-4_f64, 3e-5..6e-4_f64], senses in any::<[bool; 2]>(), direction in -PI..PI, between in -2.5..2.5_f64,
        mounting in 0.5..2.5_f64,
    ) -> Felt {
        let whisker = |index: usize| {
            let base_angle = if senses[index] { bends[index] } else { -bends[index] };
            Whisker { base_angle, tangent: unit(direction + between * index as f64), ready: true }
        };
        Felt { body: Pose { position: Point2::new(x, y), heading }, whiskers: [whisker(0), whisker(1)], mounting }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    #[test]
    fn in_a_mirror_every_law_commands_the_mirrored(
        felt in felt(), whisker in 0_usize..2, px in -1.0..1.0_f64, py in -1.0..1.0_f64, direction in -PI..PI, law in 0_usize..11,
    ) {
        let (point, along) = (Point2::new(px, py), unit(direction));
        let does = |point: Point2, along: Vector2| {
            let (point, along) = (place(point), unit_vector(along));
            [
                "do swipe(w, 300 urad, 50 mm/s)".to_owned(),
                "do swipe_tilted(w, 300 urad, 50 mm/s, 10 deg)".to_owned(),
                "do keep_centre(w, v, 300 urad, 50 mm/s)".to_owned(),
                "do go_around_edge(w, 300 urad, 50 mm/s)".to_owned(),
                format!("do detach(w, {along}, 50 mm/s)"),
                format!("do return_to_edge(w, {point}, {along}, 20 mm, 50 mm/s)"),
                format!("do reach_around(w, {point}, {along}, 10 mm, 40 deg, 20 deg, 50 mm/s)"),
                format!("do whisk_back(w, w.tip, {point}, 60 urad, 50 mm/s)"),
                format!("do reposition(w, {point}, {along}, 20 mm, 20 deg, 50 mm/s)"),
                format!("do approach(w, {along}, 50 mm/s)"),
                format!("do follow(w, {along}, 300 urad * w.side, 50 mm/s, 10 deg)"),
            ][law].clone()
        };
        let (mover, along_world, speed, turn) = commanded(whisker, &does(point, along), &felt);
        let mirrored = does(flipped(point.coords).into(), flipped(along));
        let (other_mover, other_along, other_speed, other_turn) = commanded(1 - whisker, &mirrored, &felt.mirrored());
        match (mover, other_mover) {
            (Mover::Whisker(one), Mover::Whisker(other)) => prop_assert_eq!((one, other), (whisker, 1 - whisker)),
            (one, other) => prop_assert_eq!(one, other),
        }
        prop_assert!(is_near(flipped(along_world), other_along) && (speed - other_speed).abs() < 1e-12);
        match (turn, other_turn) {
            (Turn::Facing(one), Turn::Facing(other)) => prop_assert!(turn_between(one, -other).abs() < 1e-9),
            (Turn::Rate(one), Turn::Rate(other)) => prop_assert!((one + other).abs() < 1e-12),
            (one, other) => prop_assert!(false, "{one:?} {other:?}"),
        }
        // The length of a velocity is rounded.
        prop_assert!((0.0..=0.05 + f64::EPSILON).contains(&speed), "{speed}");
    }

    #[test]
    fn the_middle_between_two_walls_does_not_depend_on_which_is_named_first(felt in felt()) {
        let (_, one, _, one_turn) = commanded(0, "do keep_centre(w, v, 300 urad, 50 mm/s)", &felt);
        let (_, other, _, other_turn) = commanded(0, "do keep_centre(v, w, 300 urad, 50 mm/s)", &felt);
        prop_assert!(is_near(one, other));
        prop_assert_eq!(one_turn, other_turn);
    }
}
