//! A whisker sticks and slides with the friction that its surface has.

use std::f64::consts::{FRAC_PI_2, PI};

use proptest::prelude::*;
use vibrissa::geometry::{Contour, Point2, Pose, Vector2, polygon, rotate, unit};
use vibrissa::physics::Physics;
use vibrissa::quasi_static::QuasiStaticWorld;
use vibrissa::world::World;
use vibrissa_runtime::rig::{Rig, Whisker};
use vibrissa_runtime::signal::{Command, Sample};

use super::scene::{START, command, drive, one_whisker, outlines, points, solids};

/// The face of a wall along y, to the right of the platform (m).
const FACE: f64 = 0.14;

fn wall() -> Contour {
    polygon(&points(&[(FACE, -1.0), (FACE + 0.2, -1.0), (FACE + 0.2, 1.0), (FACE, 1.0)])).unwrap()
}

fn with_friction(friction: f64) -> Physics {
    Physics { friction, ..Physics::default() }
}

/// One whisker on a platform that contact forces hardly move.
fn heavy_rig() -> Rig {
    let mut rig = one_whisker();
    rig.platform.mass *= 1e6;
    rig.platform.inertia *= 1e6;
    rig
}

/// A world beside the wall, after a press of 33 mm in a second along it.
fn pressed(rig: &Rig, friction: f64) -> QuasiStaticWorld {
    let start = Pose { position: Point2::new(0.0, -0.5), heading: FRAC_PI_2 };
    let mut world = QuasiStaticWorld::new(rig, &with_friction(friction), &solids([wall()]), start, 0).unwrap();
    drive(&mut world, &command(0.02, 0.05, 0.0), 50).unwrap();
    world
}

/// The force of the whisker on its base (N, world frame).
fn force(whisker: &Whisker, sample: &Sample) -> Vector2 {
    let reading = &sample.whiskers[0];
    let shaft = sample.body.heading + whisker.direction_body + reading.base_angle;
    rotate(Vector2::new(reading.axial.unwrap(), reading.shear.unwrap()), shaft)
}

/// The tip of a chain in balance, from its readings at the base, and the moment (N m) that remains there.
fn followed(whisker: &Whisker, sample: &Sample) -> (Point2, f64) {
    let force = force(whisker, sample);
    let base_angle = sample.whiskers[0].base_angle;
    let mut angle = sample.body.heading + whisker.direction_body + base_angle;
    let mut moment = whisker.hinge.stiffness * base_angle;
    let mut end = sample.body.point_to_world(whisker.base_body);
    for stiffness in whisker.shaft.joint_stiffnesses() {
        angle += moment / stiffness;
        let link = whisker.shaft.link_length() * unit(angle);
        moment -= link.perp(&force);
        end += link;
    }
    (end, moment)
}

#[test]
fn a_dragged_whisker_is_in_balance_under_a_force_at_the_angle_of_friction() {
    for friction in [0.1, 0.3, 0.6] {
        let rig = heavy_rig();
        let whisker = &rig.whiskers[0];
        let mut world = pressed(&rig, friction);
        let sample = drive(&mut world, &command(0.0, 0.05, 0.0), 60).unwrap();
        let force = force(whisker, &sample);
        assert!(force.x < -1e-3 && (force.y / force.x - friction).abs() < 1e-6, "{friction}: {force}");
        let (tip, moment) = followed(whisker, &sample);
        // The friction acts on the surface of the tip, which is a radius from its axis.
        let radius = whisker.shaft.radius_at(1.0);
        let expected = radius * force.y;
        assert!((tip.x + radius - FACE).abs() < 1e-8, "{friction}: {tip}");
        assert!((moment.abs() - expected.abs()).abs() < 1e-10, "{friction}: {moment} instead of {expected}");
        assert!((tip - world.tip(0)).norm() < 1e-8);
    }
}

#[test]
fn a_whisker_that_is_pushed_back_sticks_first_and_slides_later() {
    let (friction, rig) = (0.3, heavy_rig());
    let whisker = &rig.whiskers[0];
    let mut world = pressed(&rig, friction);
    drive(&mut world, &command(0.0, 0.05, 0.0), 30).unwrap();
    let stopped = drive(&mut world, &Command::STOP, 60).unwrap();
    let (held, from) = (world.tip(0), stopped.body.position);
    let (mut stuck, mut slid) = (0.0_f64, 0.0_f64);
    let mut forward_limit = None;
    for _ in 0..60 {
        let sample = drive(&mut world, &command(0.0, -0.01, 0.0), 1).unwrap();
        let force = force(whisker, &sample);
        let ratio = force.y / force.x;
        let pushed = (sample.body.position - from).norm();
        assert!(ratio.abs() < friction + 1e-9, "{ratio}");
        if ratio.abs() < friction - 1e-3 {
            // The tip rolls on its radius of a few tenths of a millimetre while the whisker turns.
            assert!((world.tip(0) - held).norm() < 1e-5 + 0.01 * pushed, "{pushed}");
            stuck = stuck.max(pushed);
        } else if ratio < 0.0 {
            forward_limit.get_or_insert(pushed);
            slid = pushed - forward_limit.unwrap();
            assert!(held.y - world.tip(0).y > 0.9 * slid - 1e-4, "{slid}");
        }
    }
    assert!(stuck > 2e-4 && slid > 5e-3, "stuck for {stuck} m, slid for {slid} m");
}

#[test]
fn a_whisker_that_stands_still_stays_where_it_is() {
    let rig = heavy_rig();
    let mut world = pressed(&rig, 0.3);
    drive(&mut world, &Command::STOP, 60).unwrap();
    let held = world.tip(0);
    drive(&mut world, &Command::STOP, 300).unwrap();
    assert!((world.tip(0) - held).norm() < 1e-7);
}

#[test]
fn little_friction_has_little_effect() {
    let friction = 1e-3;
    for (name, outline) in outlines() {
        let run = |friction| {
            let solids = solids([outline.clone()]);
            let mut world = QuasiStaticWorld::new(&heavy_rig(), &with_friction(friction), &solids, START, 0).unwrap();
            let tick = |_| drive(&mut world, &command(0.005, 0.04, 0.0), 1).unwrap().whiskers[0].base_angle;
            (0..130).map(tick).collect::<Vec<_>>()
        };
        let without = run(0.0);
        let largest = without.iter().copied().map(f64::abs).fold(0.0, f64::max);
        assert!(largest > 2e-5, "{name}: nothing touched");
        // A whisker may slip off in the sample before or after.
        let apart =
            run(friction).iter().zip(&without).filter(|(a, b)| (*a - *b).abs() > 5.0 * friction * largest).count();
        assert!(apart <= 3, "{name}: {apart} ticks differ");
    }
}

fn commands() -> impl Strategy<Value = Vec<(Command, usize)>> {
    let command = (-0.03..0.05_f64, -0.09..0.09_f64, -0.4..0.4_f64).prop_map(|(x, y, yaw)| command(x, y, yaw));
    proptest::collection::vec((command, 5..40_usize), 3..7)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    /// The moment at the base has the lever of the tip only if nothing else touches.
    #[test]
    fn the_force_on_a_tip_is_within_the_cone(commands in commands(), which in 0..11_usize, friction in 0.05..0.7_f64) {
        let rig = heavy_rig();
        let whisker = &rig.whiskers[0];
        let outline = outlines().swap_remove(which).1;
        let mut world =
            QuasiStaticWorld::new(&rig, &with_friction(friction), &solids([outline.clone()]), START, 0).unwrap();
        for (command, ticks) in commands {
            let Ok(_) = drive(&mut world, &command, ticks) else { return Ok(()) };
            let Ok(sample) = drive(&mut world, &Command::STOP, 30) else { return Ok(()) };
            let (tip, force) = (world.tip(0), force(whisker, &sample));
            let radius = whisker.shaft.radius_at(1.0);
            let distance = |point: Point2| outline.signed_distance(point);
            prop_assert!(distance(tip) > radius - 1e-6, "the tip is {} m inside", radius - distance(tip));
            if force.norm() < 1e-6 || distance(tip) > radius + 1e-7 {
                continue;
            }
            let probe = |direction: f64| distance(tip + 1e-6 * unit(direction)) - distance(tip - 1e-6 * unit(direction));
            let normal = Vector2::new(probe(0.0), probe(PI / 2.0)).normalize();
            let base = sample.body.point_to_world(whisker.base_body);
            let moment = whisker.hinge.stiffness * sample.whiskers[0].base_angle;
            let lever = (tip - radius * normal - base).perp(&force);
            if (moment - lever).abs() < 1e-3 * moment.abs() {
                let (pushes, rubs) = (force.dot(&normal), force.perp(&normal).abs());
                prop_assert!(rubs <= friction * pushes + 1e-4 * force.norm(), "{rubs} N across {pushes} N");
            }
        }
    }
}

/// The same commands in MuJoCo, whose contacts are compliant.
#[cfg(feature = "sim")]
#[test]
fn both_simulators_agree_along_a_wall() {
    let mut rig = one_whisker();
    rig.platform.mass *= 100.0;
    rig.platform.inertia *= 100.0;
    for friction in [0.1, 0.3] {
        let physics = Physics { step: 1.0 / 3600.0, contact_time: 1.25e-3, ..with_friction(friction) };
        let start = Pose { position: Point2::new(0.0, -0.5), heading: FRAC_PI_2 };
        let solids = solids([wall()]);
        let mut exact = QuasiStaticWorld::new(&rig, &physics, &solids, start, 0).unwrap();
        let mut engine = vibrissa::mujoco::MujocoWorld::pruned(&rig, &physics, &solids, start, 0).unwrap();
        for tick in 0..140 {
            let command = match tick {
                0..50 => command(0.02, 0.05, 0.0),
                50..80 => command(0.0, 0.05, 0.0),
                _ => command(0.0, -0.01, 0.0),
            };
            let last = |world: &mut dyn World| {
                let sample = *world.advance(&command).unwrap().last().unwrap();
                (sample.whiskers[0].base_angle, world.tip(0))
            };
            let (one, other) = (last(&mut exact), last(&mut engine));
            // The first touch and the reversal are too fast for statics.
            if (40..80).contains(&tick) || tick > 100 {
                assert!((one.1.x - other.1.x).abs() < 1e-4, "{friction}, tick {tick}: {} and {}", one.1, other.1);
                assert!((one.0 / other.0 - 1.0).abs() < 0.01, "{friction}, tick {tick}: {} and {}", one.0, other.0);
            }
        }
    }
}
