//! Whiskers that are curved at rest, in both worlds.

use vibrissa::geometry::{Point2, Pose, circle, unit};
use vibrissa::physics::Physics;
use vibrissa::quasi_static::QuasiStaticWorld;
use vibrissa::solid::Solid;
use vibrissa::world::World;
use vibrissa_runtime::rig::{Rig, Whisker};
use vibrissa_runtime::signal::{Command, Sample};

use crate::quasi_static::scene::{START, command};

/// Curvatures (1/m) of 1 mm and 2 mm aside, to both sides.
const CURVATURES: [f64; 4] = [-0.4, -0.2, 0.2, 0.4];

/// Whiskers with as many links as the cable has.
fn curved(curvature: f64) -> Rig {
    let mut rig = Rig::default();
    for whisker in &mut rig.whiskers {
        (whisker.shaft.curvature, whisker.shaft.links) = (curvature, 40);
    }
    rig
}

/// All worlds that simulate a chain.
fn chains(rig: &Rig, solids: &[Solid]) -> Vec<Box<dyn World>> {
    #[cfg_attr(not(feature = "sim"), expect(unused_mut, reason = "there is one world"))]
    let mut worlds: Vec<Box<dyn World>> =
        vec![Box::new(QuasiStaticWorld::new(rig, &Physics::default(), solids, START, 0).unwrap())];
    #[cfg(feature = "sim")]
    for build in [vibrissa::mujoco::MujocoWorld::new, vibrissa::mujoco::MujocoWorld::pruned] {
        worlds.push(Box::new(build(rig, &Physics::default(), solids, START, 0).unwrap()));
    }
    worlds
}

/// The base angle of the right whisker (rad) in every world, with every model of a shaft, after it was dragged along a disk.
fn bent(curvature: f64) -> Vec<f64> {
    let (rig, disk) = (curved(curvature), Solid::inside(circle(Point2::new(0.38, 0.3), 0.3).unwrap()).unwrap());
    let disk = std::slice::from_ref(&disk);
    let mut worlds = chains(&rig, disk);
    #[cfg(feature = "sim")]
    {
        let cable = vibrissa::physics::Preset::PeerCable.rig().1;
        worlds.push(Box::new(vibrissa::mujoco::MujocoWorld::pruned(&rig, &cable, disk, START, 0).unwrap()));
    }
    let reading = |world: &mut Box<dyn World>| {
        last(world.as_mut(), &command(0.0, 0.05, 0.0), 75);
        last(world.as_mut(), &Command::STOP, 90).whiskers[0].base_angle
    };
    worlds.iter_mut().map(reading).collect()
}

/// The end of an arc of constant curvature.
fn end_of_arc(whisker: &Whisker, body: Pose) -> Point2 {
    let (curvature, length) = (whisker.shaft.curvature, whisker.shaft.length);
    let direction = body.heading + whisker.direction_body;
    let chord = 2.0 / curvature * (0.5 * curvature * length).sin();
    body.point_to_world(whisker.base_body) + chord * unit(direction + 0.5 * curvature * length)
}

fn last(world: &mut dyn World, command: &Command, ticks: usize) -> Sample {
    (0..ticks).map(|_| *world.advance(command).unwrap().last().unwrap()).last().unwrap()
}

#[test]
fn a_whisker_in_the_air_has_the_shape_of_its_curvature_and_reads_nothing() {
    for curvature in CURVATURES {
        let rig = curved(curvature);
        for mut world in chains(&rig, &[]) {
            last(world.as_mut(), &command(0.01, 0.02, 0.1), 60);
            let sample = last(world.as_mut(), &Command::STOP, 60);
            for (index, whisker) in rig.whiskers.iter().enumerate() {
                let off = (world.tip(index) - end_of_arc(whisker, sample.body)).norm();
                assert!(off < 1e-8, "{off} m");
                assert!(sample.whiskers[index].base_angle.abs() < 1e-10);
            }
        }
    }
}

/// The contacts of the simulators are not equally soft, so that the readings of a straight whisker differ, too.
#[test]
fn the_worlds_agree_about_the_effect_of_a_curvature() {
    let straight = bent(0.0);
    for curvature in [-0.4, 0.4] {
        let ratios: Vec<f64> =
            bent(curvature).iter().zip(&straight).map(|(curved, straight)| curved / straight).collect();
        assert!((ratios[0] - 1.0).abs() > 0.03, "{ratios:?}");
        assert!(ratios.iter().all(|ratio| (ratio - ratios[0]).abs() < 1e-3), "{ratios:?}");
    }
}

#[test]
fn a_curvature_and_its_mirror_image_read_the_opposite() {
    let disks = [0.38, -0.38].map(|x| Solid::inside(circle(Point2::new(x, 0.3), 0.3).unwrap()).unwrap());
    let mut rig = curved(0.3);
    rig.whiskers[0].shaft.curvature = -0.3;
    for mut world in chains(&rig, &disks) {
        let sample = last(world.as_mut(), &command(0.0, 0.05, 0.0), 75);
        let [right, left] = [0, 1].map(|whisker: usize| sample.whiskers[whisker].base_angle);
        assert!(right.abs() > 5e-5 && (right + left).abs() < 0.01 * right.abs(), "{right} {left}");
    }
}
