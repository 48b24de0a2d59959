//! A whisker that is dragged along a wall with friction slides steadily, as a real one does, and the tip model that reckons with
//! the friction tells where its tip is.

use std::f64::consts::FRAC_PI_2;

use vibrissa::geometry::{Path, Point2, Pose, Vector2, circle, rotate};
use vibrissa::mujoco::MujocoWorld;
use vibrissa::physics::Physics;
use vibrissa::solid::Solid;
use vibrissa::world::World;
use vibrissa_runtime::percept::TipCurve;
use vibrissa_runtime::rig::Rig;
use vibrissa_runtime::signal::{Command, Sample};

/// Where the wall's face is, which lies along y to the right of the platform (m).
const FACE: f64 = 0.14;

/// A rig with steps short enough for friction.
fn rig(friction: f64) -> (Rig, Physics) {
    let mut rig = Rig::default();
    rig.whiskers.truncate(1);
    rig.sensing.forces = true;
    (rig, Physics { step: 1.0 / 1800.0, contact_time: 2.5e-3, friction, ..Physics::default() })
}

/// The last second of a drag along the wall at a speed (m/s), during which the whisker is pressed to it on the way.
fn drag((rig, physics): &(Rig, Physics), speed: f64, others: &[Solid]) -> Vec<Sample> {
    let start = Pose { position: Point2::new(FACE, 1.0), heading: -FRAC_PI_2 };
    let wall = Path::from(start).straight(2.0).turn(FRAC_PI_2).straight(0.2).turn(FRAC_PI_2).straight(2.0);
    let mut solids = vec![Solid::inside(wall.close().unwrap()).unwrap()];
    solids.extend_from_slice(others);
    let start = Pose { position: Point2::new(0.0, -0.5), heading: FRAC_PI_2 };
    let mut world = MujocoWorld::new(rig, physics, &solids, start, 0).unwrap();
    let mut last = Vec::new();
    for tick in 0..120 {
        let aside = if tick < 50 { 0.02 } else { 0.0 };
        let samples = world.advance(&Command { velocity_world: Vector2::new(aside, speed), yaw_rate: 0.0 }).unwrap();
        if tick >= 90 {
            last.extend_from_slice(samples);
        }
    }
    last
}

#[test]
fn a_tip_slides_steadily_with_the_force_that_its_friction_makes() {
    for friction in [0.1, 0.3] {
        for speed in [0.02, 0.05, 0.1] {
            let samples = drag(&rig(friction), speed, &[]);
            // It still settles at the lowest speed; ringing would be some 10 urad.
            let angles: Vec<f64> = samples.iter().map(|sample| sample.whiskers[0].base_angle).collect();
            let jump = angles.windows(2).map(|pair| (pair[1] - pair[0]).abs()).fold(0.0, f64::max);
            assert!(jump < 1e-7 && angles[0] < -1e-4, "{friction} at {speed} m/s: {jump} rad from sample to sample");
            for sample in samples {
                let shaft = sample.body.heading + Rig::default().whiskers[0].direction_body;
                let reading = &sample.whiskers[0];
                let force = rotate(Vector2::new(reading.axial.unwrap(), reading.shear.unwrap()), shaft);
                let ratio = (force.y / force.x).abs();
                assert!((ratio - friction).abs() < 0.03, "{friction} at {speed} m/s: a ratio of {ratio}");
            }
        }
    }
}

#[test]
fn a_wall_beside_other_solids_rubs_like_one_alone() {
    let far = Solid::inside(circle(Point2::new(50.0, 0.0), 0.1).unwrap()).unwrap();
    let (alone, beside) = (drag(&rig(0.3), 0.05, &[]), drag(&rig(0.3), 0.05, &[far]));
    for (a, b) in alone.iter().zip(&beside) {
        assert!((a.whiskers[0].base_angle - b.whiskers[0].base_angle).abs() < 1e-9);
    }
}

#[test]
fn the_tip_model_that_reckons_with_the_friction_finds_the_wall() {
    for (friction, unknown) in [(0.1, 0.4e-3), (0.3, 1.2e-3)] {
        let rig = rig(friction);
        let whisker = &rig.0.whiskers[0];
        let sample = *drag(&rig, 0.05, &[]).last().unwrap();
        let off = |model: &TipCurve| {
            let contact = rotate(model.contact_base(sample.whiskers[0].base_angle), whisker.direction_body);
            let place = sample.body.point_to_world(whisker.base_body + contact);
            (place.x - FACE).abs()
        };
        let (known, unknowing) =
            (off(&TipCurve::with_friction(whisker, friction).unwrap()), off(&TipCurve::new(whisker).unwrap()));
        assert!(known < 0.1e-3, "{friction}: {known} m off");
        assert!(unknowing > unknown, "{friction}: only {unknowing} m off without it");
    }
}
