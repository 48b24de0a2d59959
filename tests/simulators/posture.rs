//! The positions of platform and whiskers that worlds report.

use std::f64::consts::FRAC_PI_2;

use nalgebra::Point3;
use vibrissa::geometry::{Point2, Pose, Vector2, circle, unit};
use vibrissa::physics::Physics;
use vibrissa::quasi_static::QuasiStaticWorld;
use vibrissa::solid::Solid;
use vibrissa::world::{Posture, World};
use vibrissa_runtime::rig::Rig;
use vibrissa_runtime::signal::Command;

const START: Pose = Pose { position: Point2::new(0.0, 0.072), heading: FRAC_PI_2 };

/// A disk to which the right whisker comes. The left one touches nothing.
fn disk() -> [Solid; 1] {
    [Solid::inside(circle(Point2::new(0.4, 0.4), 0.3).unwrap()).unwrap()]
}

fn worlds() -> Vec<(&'static str, Box<dyn World>)> {
    let world = QuasiStaticWorld::new(&Rig::default(), &Physics::default(), &disk(), START, 0).unwrap();
    let quasi_static: (_, Box<dyn World>) = ("quasi-static", Box::new(world));
    mujoco_worlds().into_iter().chain([quasi_static]).collect()
}

#[cfg(not(feature = "sim"))]
fn mujoco_worlds() -> [(&'static str, Box<dyn World>); 0] {
    []
}

#[cfg(feature = "sim")]
fn mujoco_worlds() -> [(&'static str, Box<dyn World>); 4] {
    use vibrissa::mujoco::MujocoWorld;
    use vibrissa::physics::ShaftModel;

    let world = |shafts, pruned: bool| -> Box<dyn World> {
        let physics = Physics { shafts, ..Physics::default() };
        let build = if pruned { MujocoWorld::pruned } else { MujocoWorld::new };
        Box::new(build(&Rig::default(), &physics, &disk(), START, 0).unwrap())
    };
    [
        ("chain", world(ShaftModel::Chain, false)),
        ("pruned chain", world(ShaftModel::Chain, true)),
        ("cable", world(ShaftModel::Cable, false)),
        ("spatial chain", world(ShaftModel::SpatialChain, false)),
    ]
}

fn length(shaft: &[Point3<f64>]) -> f64 {
    shaft.windows(2).map(|ends| (ends[1] - ends[0]).norm()).sum()
}

/// The largest distance of a point of the shaft from the straight line between its ends.
fn bend(shaft: &[Point3<f64>]) -> f64 {
    let (base, tip) = (shaft[0], shaft[shaft.len() - 1]);
    let along = (tip - base).normalize();
    let distance = |point: &Point3<f64>| (point - base).cross(&along).norm();
    shaft.iter().map(distance).fold(0.0, f64::max)
}

#[test]
fn a_shaft_goes_from_the_base_on_the_platform_to_the_tip_and_keeps_its_length() {
    let rig = Rig::default();
    for (name, mut world) in worlds() {
        let mut largest_bends = [0.0_f64; 2];
        for _ in 0..200 {
            let command = Command { velocity_world: Vector2::new(0.0, 0.05), yaw_rate: 0.0 };
            let body = world.advance(&command).unwrap().last().unwrap().body;
            let Posture { body: shown, shafts } = world.posture().unwrap();
            assert_eq!(shown, body, "{name}");
            assert_eq!(shafts.len(), rig.whiskers.len(), "{name}");
            for (index, (shaft, whisker)) in shafts.iter().zip(&rig.whiskers).enumerate() {
                let base = body.point_to_world(whisker.base_body);
                assert!((shaft[0] - Point3::new(base.x, base.y, 0.0)).norm() < 1e-12, "{name}");
                assert!((shaft[shaft.len() - 1].xy() - world.tip(index)).norm() < 1e-12, "{name}");
                assert!((length(shaft) - whisker.shaft.length).abs() < 1e-9, "{name}: {} m", length(shaft));
                largest_bends[index] = largest_bends[index].max(bend(shaft));
                // Without a touch, the shaft has the direction in which it is mounted.
                if bend(shaft) < 1e-9 {
                    let direction = unit(body.heading + whisker.direction_body);
                    let ahead = shaft[shaft.len() - 1].xy() - shaft[0].xy();
                    assert!((ahead.normalize() - direction).norm() < 1e-6, "{name}");
                }
            }
        }
        let touching = largest_bends[0].max(largest_bends[1]);
        assert!(touching > 5e-3, "{name}: the whisker on the disk bends, not by {touching} m only");
    }
}
