//! A platform that stops stands still, whatever its bent whiskers push.
use std::f64::consts::FRAC_PI_2;

use vibrissa::geometry::{Point2, Pose, Vector2, polygon};
use vibrissa::physics::Physics;
use vibrissa::quasi_static::QuasiStaticWorld;
use vibrissa::solid::Solid;
use vibrissa::world::World;
use vibrissa_runtime::machine::Action;
use vibrissa_runtime::motion::Steering;
use vibrissa_runtime::rig::Rig;
use vibrissa_runtime::signal::{Command, Sample};

/// Upwards beside the wall, which the unbent right whisker does not touch.
const START: Pose = Pose { position: Point2::new(0.0, 0.0), heading: FRAC_PI_2 };

/// The rig beside a wall to its right in every world that there is.
fn worlds(rig: &Rig) -> Vec<Box<dyn World>> {
    let corners = [(0.13, -1.0), (0.18, -1.0), (0.18, 1.0), (0.13, 1.0)].map(|(x, y)| Point2::new(x, y));
    let solids = [Solid::inside(polygon(&corners).unwrap()).unwrap()];
    #[cfg_attr(not(feature = "sim"), expect(unused_mut, reason = "there is one world only"))]
    let mut worlds: Vec<Box<dyn World>> =
        vec![Box::new(QuasiStaticWorld::new(rig, &Physics::default(), &solids, START, 0).unwrap())];
    #[cfg(feature = "sim")]
    worlds.push(Box::new(vibrissa::mujoco::MujocoWorld::new(rig, &Physics::default(), &solids, START, 0).unwrap()));
    worlds
}

fn drive(world: &mut dyn World, command: &Command, time: f64) -> Sample {
    let mut last = None;
    let mut elapsed = 0.5 / 30.0;
    while elapsed < time {
        elapsed += 1.0 / 30.0;
        last = world.advance(command).unwrap().last().copied();
    }
    last.unwrap()
}

/// Stops for so long (s) from the sample `last` on; the newest one, and how far and by how much the platform was off its first pose in
/// any tick after `since` (s).
fn stop(world: &mut dyn World, steering: &mut Steering, mut last: Sample, time: f64, since: f64) -> (Sample, f64, f64) {
    let first = last.body;
    let (mut off, mut turned) = (0.0_f64, 0.0_f64);
    let ticks = (0_u32..).map(|tick| f64::from(tick) / 30.0).take_while(|elapsed| *elapsed < time - 0.5 / 30.0);
    for elapsed in ticks {
        let command = steering.command(&Action::Stop, last.body);
        assert!(command.is_finite() && command.velocity_world.norm() < 0.021 && command.yaw_rate.abs() < 0.21);
        last = *world.advance(&command).unwrap().last().unwrap();
        if elapsed > since {
            off = off.max((last.body.position - first.position).norm());
            turned = turned.max((last.body.heading - first.heading).abs());
        }
    }
    (last, off, turned)
}

#[test]
fn a_bent_whisker_does_not_push_a_platform_that_stops() {
    let rig = Rig::default();
    for stiff in [0.7, 1.0, 4.0] {
        let mut rig = rig.clone();
        rig.whiskers.iter_mut().for_each(|whisker| whisker.shaft.young_modulus *= stiff);
        for mut world in worlds(&rig) {
            // Towards the wall and along it, so that the whisker lies as by swiping, and at rest.
            drive(world.as_mut(), &Command { velocity_world: Vector2::new(0.025, 0.05), yaw_rate: 0.0 }, 1.0);
            let pressed = drive(world.as_mut(), &Command::STOP, 0.6);
            assert!(pressed.whiskers[0].base_angle.abs() > 1.5e-4, "{}", pressed.whiskers[0].base_angle);
            let mut steering = Steering::new(&rig, &[Some(0), Some(1)]);
            let (last, off, turned) = stop(world.as_mut(), &mut steering, pressed, 120.0, 2.0);
            assert!(off < 1e-4 && turned < 0.05_f64.to_radians(), "{off} m, {turned} rad");
            assert!(last.whiskers[0].base_angle.abs() > 1.5e-4, "the whisker still pushes");
        }
    }
}

#[test]
fn without_holding_it_drifts_by_centimetres() {
    for mut world in worlds(&Rig::default()) {
        drive(world.as_mut(), &Command { velocity_world: Vector2::new(0.025, 0.05), yaw_rate: 0.0 }, 1.0);
        let pressed = drive(world.as_mut(), &Command::STOP, 0.6);
        let last = drive(world.as_mut(), &Command::STOP, 120.0);
        assert!((last.body.position - pressed.body.position).norm() > 5e-3);
    }
}

#[test]
fn a_platform_that_brakes_does_not_go_back_to_where_it_was_told_to_stop() {
    for mut world in worlds(&Rig { whiskers: Vec::new(), ..Rig::default() }) {
        let (mut steering, going) =
            (Steering::new(&Rig::default(), &[]), Command { velocity_world: Vector2::new(0.0, 0.1), yaw_rate: 0.5 });
        let before = drive(world.as_mut(), &going, 1.0);
        let (rested, ..) = stop(world.as_mut(), &mut steering, before, 0.6, 0.0);
        let coasted = rested.body.position.y - before.body.position.y;
        // Worlds differ by what they take for the speed within a sample.
        assert!((coasted - 0.1 * 0.05).abs() < 0.1 / 300.0 + 1e-5, "it coasts {coasted} m");
        let (_, off, turned) = stop(world.as_mut(), &mut steering, rested, 10.0, 0.0);
        assert!(off < 1e-5 && turned < 5e-5, "{off} m, {turned} rad");
    }
}

#[test]
fn holding_the_last_command_goes_on_stopping_and_any_other_command_ends_it() {
    let mut steering = Steering::new(&Rig::default(), &[]);
    let pose = |y| Pose { position: Point2::new(0.0, y), heading: 0.0 };
    for _ in 0..60 {
        assert_eq!(steering.command(&Action::Stop, pose(0.0)), Command::STOP);
    }
    let back = steering.command(&Action::Hold, pose(1e-3));
    assert!(back.velocity_world.y < 0.0, "{back:?}");
    assert_eq!(steering.command(&Action::Stop, Pose::UNKNOWN), Command::STOP);
    let steer = Action::Steer {
        mover: vibrissa_runtime::machine::Mover::Body,
        along_world: Vector2::new(1.0, 0.0),
        speed: 0.05,
        turn: vibrissa_runtime::machine::Turn::Rate(0.0),
    };
    let going = steering.command(&steer, pose(1e-3));
    assert_eq!(steering.command(&Action::Hold, pose(2e-3)), going);
    assert_eq!(steering.command(&Action::Stop, pose(3e-3)), Command::STOP, "it brakes first");
}
