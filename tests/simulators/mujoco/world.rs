//! The MuJoCo world against closed forms, and its ways to end.

use std::f64::consts::FRAC_PI_2;

use vibrissa::geometry::{Point2, Pose, Vector2, circle, polygon};
use vibrissa::mujoco::MujocoWorld;
use vibrissa::physics::Physics;
use vibrissa::solid::Solid;
use vibrissa::world::{Fault, World};
use vibrissa_runtime::rig::Rig;
use vibrissa_runtime::signal::{Command, Sample};

fn disk() -> [Solid; 1] {
    [Solid::inside(circle(Point2::new(0.4, 0.4), 0.3).unwrap()).unwrap()]
}

/// A wall 20 mm before the nose, out of the whiskers' reach.
fn wall_ahead() -> [Solid; 1] {
    let corners = [(0.1, 0.2), (0.1, 0.3), (-0.1, 0.3), (-0.1, 0.2)].map(|(x, y)| Point2::new(x, y));
    [Solid::inside(polygon(&corners).unwrap()).unwrap()]
}

const START: Pose = Pose { position: Point2::new(0.0, 0.072), heading: FRAC_PI_2 };

fn command(x: f64, y: f64, yaw_rate: f64) -> Command {
    Command { velocity_world: Vector2::new(x, y), yaw_rate }
}

fn samples(world: &mut MujocoWorld, command: &Command, ticks: usize) -> Result<Vec<Sample>, Fault> {
    let mut samples = Vec::new();
    for _ in 0..ticks {
        samples.extend_from_slice(world.advance(command)?);
    }
    Ok(samples)
}

#[test]
fn servos_follow_a_command_with_their_time_constant() {
    let rig = Rig::default();
    let mut world = MujocoWorld::new(&rig, &Physics::default(), &[], START, 0).unwrap();
    let servo = rig.platform.servo;
    for sample in samples(&mut world, &command(0.03, -0.02, 0.5), 60).unwrap() {
        // Discrete steps keep a first-order lag exact up to one step's share of it.
        let travelled = sample.time - servo * (1.0 - (-sample.time / servo).exp());
        let expected = START.position + travelled * Vector2::new(0.03, -0.02);
        assert!((sample.body.position - expected).norm() < 0.04 * Physics::default().step, "at {} s", sample.time);
        assert!((sample.body.heading - START.heading - 0.5 * travelled).abs() < 0.5 * Physics::default().step);
    }
}

#[test]
fn a_platform_at_rest_in_free_air_stays_there_and_feels_nothing() {
    let mut world = MujocoWorld::new(&Rig::default(), &Physics::default(), &disk(), START, 0).unwrap();
    for sample in samples(&mut world, &Command::STOP, 30).unwrap() {
        assert!((sample.body.position - START.position).norm() < 1e-12);
        assert!(sample.whiskers.iter().all(|whisker| whisker.base_angle.abs() < 1e-12));
    }
}

#[test]
fn a_tick_gives_one_sample_a_sample_period() {
    let mut world = MujocoWorld::new(&Rig::default(), &Physics::default(), &[], START, 0).unwrap();
    let times: Vec<f64> = samples(&mut world, &Command::STOP, 3).unwrap().iter().map(|sample| sample.time).collect();
    assert_eq!(times.len(), 30);
    for (index, time) in times.iter().enumerate() {
        assert!((time - (index + 1) as f64 / 300.0).abs() < 1e-12);
    }
}

#[test]
fn the_same_seed_gives_the_same_noise_and_another_seed_another() {
    let mut rig = Rig::default();
    rig.sensing.angle_noise = 1e-6;
    let run = |seed| {
        let mut world = MujocoWorld::new(&rig, &Physics::default(), &[], START, seed).unwrap();
        let samples = samples(&mut world, &Command::STOP, 100).unwrap();
        samples.iter().map(|sample| sample.whiskers[1].base_angle).collect::<Vec<_>>()
    };
    let (first, again, other) = (run(1), run(1), run(2));
    assert_eq!(first, again);
    assert_ne!(first, other);
    let deviation = (first.iter().map(|angle| angle * angle).sum::<f64>() / first.len() as f64).sqrt();
    assert!((deviation / 1e-6 - 1.0).abs() < 0.1, "the noise is {deviation:e}");
}

#[test]
fn readings_are_whole_steps_of_the_resolution() {
    let mut rig = Rig::default();
    (rig.sensing.angle_noise, rig.sensing.angle_resolution) = (1e-5, 4e-6);
    let mut world = MujocoWorld::new(&rig, &Physics::default(), &[], START, 0).unwrap();
    for sample in samples(&mut world, &Command::STOP, 10).unwrap() {
        let steps = sample.whiskers[0].base_angle / 4e-6;
        assert!((steps - steps.round()).abs() < 1e-9);
    }
}

/// The force that a whisker feels at its base must balance the moment that its hinge feels.
#[test]
fn base_forces_turn_the_hinge_by_the_lever_of_the_tip() {
    let mut rig = Rig::default();
    rig.sensing.forces = true;
    let mut world = MujocoWorld::new(&rig, &Physics::default(), &disk(), START, 0).unwrap();
    samples(&mut world, &command(0.0, 0.05, 0.0), 150).unwrap();
    let sample = *samples(&mut world, &Command::STOP, 60).unwrap().last().unwrap();
    let right = sample.whiskers[0];
    let force = Vector2::new(right.axial.unwrap(), right.shear.unwrap());
    let model = vibrissa_runtime::mechanics::ShaftChain::new(&rig.whiskers[0]);
    // The chain bends clockwise; mirror the force to solve it counter-clockwise. What the shaft passes on to the platform is
    // what the object does to its tip.
    let direction = (-force.y).atan2(force.x);
    let mut guess = model.at_rest();
    for share in 1..=20 {
        let angle = right.base_angle.abs() * f64::from(share) / 20.0;
        guess.force = force.norm() * f64::from(share) / 20.0;
        guess = model.solve(angle, direction, &guess).unwrap();
    }
    assert!((guess.force / force.norm() - 1.0).abs() < 1e-3, "{} N against {} N", guess.force, force.norm());
}

#[test]
fn a_body_that_runs_into_the_object_is_seen_and_one_that_passes_is_not() {
    let wall = wall_ahead();
    let mut world = MujocoWorld::new(&Rig::default(), &Physics::default(), &wall, START, 0).unwrap();
    let mut touched = false;
    for _ in 0..60 {
        world.advance(&command(0.0, 0.02, 0.0)).unwrap();
        touched |= world.body_touches();
    }
    assert!(touched, "the nose is 20 mm before the wall");

    let mut world = MujocoWorld::new(&Rig::default(), &Physics::default(), &wall, START, 0).unwrap();
    for _ in 0..60 {
        world.advance(&command(0.0, -0.02, 0.0)).unwrap();
        assert!(!world.body_touches());
    }
}

#[test]
fn a_nose_that_is_a_point_stops_at_the_object_where_a_wide_one_does() {
    let stop = |nose_width: f64| {
        let mut rig = Rig::default();
        rig.platform.nose_width = nose_width;
        let mut world = MujocoWorld::new(&rig, &Physics::default(), &wall_ahead(), START, 0).unwrap();
        let last = samples(&mut world, &command(0.0, 0.02, 0.0), 90).unwrap().pop().unwrap();
        assert!(world.body_touches());
        last.body.position.y + 0.108
    };
    let (point, wide) = (stop(0.0), stop(0.03));
    assert!((point - 0.2).abs() < 0.2e-3 && (point - wide).abs() < 0.1e-3, "{point} m, {wide} m");
}

#[test]
fn a_body_that_is_forced_into_the_object_crashes() {
    let mut rig = Rig::default();
    rig.platform.servo = 1e-3;
    let mut world = MujocoWorld::new(&rig, &Physics::default(), &wall_ahead(), START, 0).unwrap();
    let fault = samples(&mut world, &command(0.0, 1.0, 0.0), 30).unwrap_err();
    assert!(matches!(fault, Fault::Crash { depth, .. } if depth > Physics::default().penetration_limit), "{fault}");
}

#[test]
fn a_whisker_that_is_forced_into_the_object_ends_the_run() {
    let physics = Physics { penetration_limit: 1e-5, ..Physics::default() };
    let mut world = MujocoWorld::new(&Rig::default(), &physics, &disk(), START, 0).unwrap();
    let fault = samples(&mut world, &command(0.0, 0.05, 0.0), 150).unwrap_err();
    assert!(matches!(fault, Fault::Penetration { depth, limit, .. } if depth > limit), "{fault}");
}

/// The advice halves the present values. It never repeats them, and does not name steps that are short already.
#[test]
fn a_penetration_is_answered_with_shorter_steps_unless_they_are_short() {
    let advice = |step: f64, contact_time: f64| {
        let physics = Physics { penetration_limit: 1e-6, step, contact_time, ..Physics::default() };
        let mut world = MujocoWorld::new(&Rig::default(), &physics, &disk(), START, 0).unwrap();
        samples(&mut world, &command(0.0, 0.05, 0.0), 150).unwrap_err().to_string()
    };
    let long = advice(1.0 / 300.0, 1.0 / 300.0);
    assert!(long.contains("as `physics: {step: 1.66667 ms, contact_time: 1.66667 ms}`, or reduce the speed"), "{long}");
    let short = advice(1.0 / 1800.0, 1.25e-3);
    assert!(short.contains("; reduce the speed: a whisker that springs round a sharp corner"), "{short}");
    assert!(!short.contains("physics"), "{short}");
}

#[test]
fn a_divergence_ends_the_run_where_the_engine_would_go_on() {
    let mut world = MujocoWorld::new(&Rig::default(), &Physics::default(), &disk(), START, 0).unwrap();
    let fault = samples(&mut world, &command(f64::NAN, 0.0, 0.0), 1).unwrap_err();
    assert!(matches!(&fault, Fault::Diverged { .. }), "{fault}");

    let mut world = MujocoWorld::new(&Rig::default(), &Physics::default(), &disk(), START, 0).unwrap();
    let fault = samples(&mut world, &command(1e9, 0.0, 1e9), 300).unwrap_err();
    assert!(matches!(&fault, Fault::Diverged { .. }), "{fault}");
}
