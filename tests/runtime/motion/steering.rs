//! Steering against the motion of a rigid body.

use std::f64::consts::PI;

use proptest::prelude::*;
use vibrissa::geometry::{Point2, Pose, Vector2, turn_between, unit};
use vibrissa_runtime::machine::{Action, Mover, Turn};
use vibrissa_runtime::motion::Steering;
use vibrissa_runtime::rig::Rig;
use vibrissa_runtime::signal::Command;

fn steering() -> (Steering, Rig) {
    let rig = Rig::default();
    (Steering::new(&rig, &[Some(0), Some(1)]), rig)
}

/// The pose after `time` seconds of `command`.
fn after(body: Pose, command: Command, time: f64) -> Pose {
    Pose { position: body.position + time * command.velocity_world, heading: body.heading + time * command.yaw_rate }
}

fn turns() -> impl Strategy<Value = Turn> {
    prop_oneof![(-2.0..2.0_f64).prop_map(Turn::Rate), (-10.0..10.0_f64).prop_map(Turn::Facing)]
}

/// Speeds forwards and backwards.
fn speeds() -> impl Strategy<Value = f64> {
    prop_oneof![1e-3..0.3_f64, -0.3..-1e-3_f64]
}

proptest! {
    #[test]
    fn a_body_that_moves_a_whisker_keeps_its_speed_and_makes_up_for_the_swing_by_its_direction(
        heading in -10.0..10.0_f64, along in -PI..PI, length in 1e-3..1e3_f64, speed in speeds(), turn in turns(),
        whisker in 0_usize..2,
    ) {
        let (mut steering, rig) = steering();
        let body = Pose { position: Point2::new(0.3, -0.7), heading };
        let action = Action::Steer { mover: Mover::Whisker(whisker), along_world: length * unit(along), speed, turn };
        let command = steering.command(&action, body);
        prop_assert!((command.velocity_world.norm() - speed.abs()).abs() < 1e-12);

        // What turning alone does to the base, by differences.
        let turning = Command { velocity_world: Vector2::zeros(), ..command };
        let base = |time| after(body, turning, time).point_to_world(rig.whiskers[whisker].base_body);
        let swing = (base(1e-6) - base(-1e-6)) / 2e-6;
        let wanted = speed * unit(along) - swing;
        prop_assert!(wanted.perp(&command.velocity_world).abs() < 1e-8 && wanted.dot(&command.velocity_world) >= 0.0);
    }

    #[test]
    fn the_body_gets_exactly_the_velocity_asked_for(
        heading in -10.0..10.0_f64, along in -PI..PI, length in 1e-3..1e3_f64, speed in speeds(), turn in turns(),
    ) {
        let (mut steering, _) = steering();
        let action = Action::Steer { mover: Mover::Body, along_world: length * unit(along), speed, turn };
        let command = steering.command(&action, Pose { position: Point2::origin(), heading });
        prop_assert!((command.velocity_world - speed * unit(along)).norm() < 1e-12);
        match turn {
            Turn::Rate(rate) => prop_assert!((command.yaw_rate - rate).abs() < 1e-15),
            Turn::Facing(wanted) => prop_assert!(command.yaw_rate * turn_between(heading, wanted) >= 0.0),
        }
    }
}

#[test]
fn no_command_exceeds_the_platforms_limits() {
    let (mut steering, rig) = steering();
    let along_world = Vector2::new(0.0, 1.0);
    for mover in [Mover::Body, Mover::Whisker(0)] {
        for (speed, rate) in [(1e300, -1e300), (-1e300, 1e300)] {
            let action = Action::Steer { mover, along_world, speed, turn: Turn::Rate(rate) };
            let command = steering.command(&action, Pose::default());
            assert!((command.velocity_world.norm() - rig.platform.speed_limit).abs() < 1e-12);
            assert!((command.yaw_rate - rig.platform.yaw_rate_limit * rate.signum()).abs() < 1e-12);
        }
    }
}

#[test]
fn a_pose_that_is_not_a_number_stands_still() {
    let (mut steering, _) = steering();
    let lost = Pose { position: Point2::origin(), heading: f64::NAN };
    let along_world = Vector2::new(0.0, 1.0);
    for (mover, turn) in [(Mover::Body, Turn::Facing(0.0)), (Mover::Whisker(1), Turn::Rate(0.1))] {
        let action = Action::Steer { mover, along_world, speed: 0.05, turn };
        assert_eq!(steering.command(&action, lost), Command::STOP);
        assert_ne!(steering.command(&action, Pose::default()), Command::STOP, "and goes on when the pose is back");
    }
}

#[test]
fn no_direction_stands_still_holding_repeats_and_stopping_stops() {
    let (mut steering, _) = steering();
    let body = Pose::default();
    let go = |along_world| Action::Steer { mover: Mover::Body, along_world, speed: 0.1, turn: Turn::Rate(0.5) };
    assert_eq!(steering.command(&Action::Hold, body), Command::STOP);
    let still = steering.command(&go(Vector2::zeros()), body);
    assert_eq!(still, Command { velocity_world: Vector2::zeros(), yaw_rate: 0.5 });
    let moving = steering.command(&go(Vector2::new(0.0, 2.0)), body);
    assert_eq!(steering.command(&Action::Hold, body), moving);
    assert_eq!(steering.command(&Action::Stop, body), Command::STOP);
    assert_eq!(steering.command(&Action::Hold, body), Command::STOP);
}

#[test]
fn a_body_that_faces_a_heading_comes_to_it_by_the_shorter_way() {
    let (mut steering, _) = steering();
    let mut body = Pose { position: Point2::origin(), heading: 3.0 };
    let facing =
        Action::Steer { mover: Mover::Body, along_world: Vector2::zeros(), speed: 0.0, turn: Turn::Facing(-3.0) };
    for _ in 0..1200 {
        let command = steering.command(&facing, body);
        assert!(command.yaw_rate.abs() <= Rig::default().platform.yaw.limit);
        body = after(body, command, 1.0 / 30.0);
        assert!((2.9..3.7).contains(&body.heading), "{}", body.heading);
    }
    assert!(turn_between(body.heading, -3.0).abs() < 1e-3);
}
