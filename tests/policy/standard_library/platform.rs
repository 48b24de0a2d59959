//! Distances from the platform.
#![allow(clippy::float_cmp, reason = "what is exact is compared exactly")]

use std::sync::Arc;

use proptest::prelude::*;
use vibrissa_language::compile;
use vibrissa_runtime::geometry::{Point2, Pose};
use vibrissa_runtime::machine::{Action, Machine};
use vibrissa_runtime::percept::Perception;
use vibrissa_runtime::rig::Rig;
use vibrissa_runtime::signal::{MAX_WHISKERS, Reading, Sample};
use vibrissa_text::diagnostic::Source;

/// What a policy computes for a body with this pose, in metres.
fn told(rig: &Rig, pose: Pose, value: &str) -> f64 {
    let text = format!(
        "machine m use std.platform initial A
        state A {{ steer body along vector(1, 0) at {value} * 1 Hz turning 0 rad/s }}"
    );
    let program = compile(&Source::new("m.fsm", text)).unwrap();
    let mut perception = Perception::new(rig, &[], &[]).unwrap();
    perception.update(&[Sample { time: 0.0, body: pose, whiskers: [Reading::default(); MAX_WHISKERS] }]);
    match Machine::new(Arc::new(program)).tick(&mut perception).action {
        Action::Steer { speed, .. } => speed,
        other => panic!("{other:?}"),
    }
}

/// The distance from a polygon that runs counter-clockwise, side by side. It is negative inside.
fn distance(corners: &[Point2], place: Point2) -> f64 {
    let sides = || corners.iter().zip(corners.iter().cycle().skip(1));
    let nearest = sides().map(|(a, b)| {
        let side = b - a;
        let share = ((place - a).dot(&side) / side.norm_squared()).clamp(0.0, 1.0);
        (place - (a + share * side)).norm()
    });
    let is_inside = sides().all(|(a, b)| (b - a).perp(&(place - a)) > 0.0);
    let nearest = nearest.fold(f64::INFINITY, f64::min);
    if is_inside { -nearest } else { nearest }
}

prop_compose! {
    fn rigs()(length in 0.05..0.4, nose in 0.001..0.3, tail in 0.001..0.3, share in 0.0..1.0) -> Rig {
        let mut rig = Rig::default();
        (rig.platform.length, rig.platform.nose_width, rig.platform.tail_width) = (length, nose, tail);
        rig.platform.centre_of_mass = share * length;
        rig
    }
}

proptest! {
    #[test]
    fn clearance_is_the_distance_from_the_outline_of_the_rig(
        rig in rigs(), (x, y, heading) in (-1.0..1.0, -1.0..1.0, -4.0..4.0), (ahead, left) in (-0.5..0.5, -0.3..0.3),
    ) {
        let pose = Pose { position: Point2::new(x, y), heading };
        let place = pose.point_to_world(Point2::new(ahead, left));
        let clearance = told(&rig, pose, &format!("clearance(position({:?} m, {:?} m))", place.x, place.y));
        let expected = distance(&rig.platform.outline_body(), Point2::new(ahead, left));
        prop_assert!((clearance - expected).abs() < 1e-9, "{} {}", clearance, expected);
    }

    #[test]
    fn the_body_has_the_measures_of_the_rig(
        rig in rigs(), (x, y, heading) in (-1.0..1.0, -1.0..1.0, -4.0..4.0),
    ) {
        let pose = Pose { position: Point2::new(x, y), heading };
        let platform = &rig.platform;
        prop_assert_eq!(told(&rig, pose, "body.length"), platform.length);
        prop_assert_eq!(told(&rig, pose, "body.width"), platform.nose_width.max(platform.tail_width));
        prop_assert_eq!(told(&rig, pose, "body.nose_width"), platform.nose_width);
        prop_assert_eq!(told(&rig, pose, "body.tail_width"), platform.tail_width);
        for (end, reach) in [("nose", platform.length - platform.centre_of_mass), ("tail", -platform.centre_of_mass)] {
            let expected = pose.point_to_world(Point2::new(reach, 0.0));
            let place = format!("position({:?} m, {:?} m)", expected.x, expected.y);
            let apart = told(&rig, pose, &format!("|body.{end} - {place}|"));
            prop_assert!(apart.abs() < 1e-12, "{}", apart);
        }
    }
}
