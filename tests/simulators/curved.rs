//! Whiskers that are curved at rest, in both worlds.

use vibrissa::geometry::{Point2, Pose, circle, unit};
use vibrissa::physics::{Physics, Preset};
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

/// All worlds, with all models of a shaft.
fn worlds(rig: &Rig, solids: &[Solid]) -> Vec<Box<dyn World>> {
    #[cfg_attr(not(feature = "sim"), expect(unused_mut, reason = "there is one world"))]
    let mut worlds: Vec<Box<dyn World>> =
        vec![Box::new(QuasiStaticWorld::new(rig, &Physics::default(), solids, START, 0).unwrap())];
    #[cfg(feature = "sim")]
    for preset in [Preset::Reference, Preset::PeerCable] {
        let build =
            |pruned| if pruned { vibrissa::mujoco::MujocoWorld::pruned } else { vibrissa::mujoco::MujocoWorld::new };
        for pruned in [false, true] {
            worlds.push(Box::new(build(pruned)(rig, &preset.rig().1, solids, START, 0).unwrap()));
        }
    }
    #[cfg(not(feature = "sim"))]
    let _ = Preset::ALL;
    worlds
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
        for mut world in worlds(&rig, &[]) {
            let sample = last(world.as_mut(), &command(0.01, 0.02, 0.1), 60);
            let sample_at_rest = last(world.as_mut(), &Command::STOP, 60);
            assert!((sample_at_rest.body.position - sample.body.position).norm() < 2e-3);
            for (index, whisker) in rig.whiskers.iter().enumerate() {
                let off = (world.tip(index) - end_of_arc(whisker, sample_at_rest.body)).norm();
                assert!(off < 1e-6, "{off} m");
                assert!(sample_at_rest.whiskers[index].base_angle.abs() < 1e-8);
            }
        }
    }
}

/// A straight whisker whose tip is where that of the curved one is bends otherwise, so this is not only a matter of direction.
#[test]
fn the_worlds_agree_about_a_curved_whisker_that_is_bent() {
    let disk = Solid::inside(circle(Point2::new(0.38, 0.3), 0.3).unwrap()).unwrap();
    for curvature in CURVATURES {
        let rig = curved(curvature);
        let readings: Vec<f64> = worlds(&rig, std::slice::from_ref(&disk))
            .iter_mut()
            .map(|world| {
                last(world.as_mut(), &command(0.0, 0.05, 0.0), 75);
                last(world.as_mut(), &Command::STOP, 90).whiskers[0].base_angle
            })
            .collect();
        let reference = readings[0];
        assert!(reference.abs() > 5e-5, "{readings:?}");
        assert!(readings.iter().all(|reading| (reading / reference - 1.0).abs() < 0.02), "{readings:?}");
    }
}

#[test]
fn a_curvature_and_its_mirror_image_read_the_opposite() {
    let disks = [0.38, -0.38].map(|x| Solid::inside(circle(Point2::new(x, 0.3), 0.3).unwrap()).unwrap());
    let mut rig = curved(0.3);
    rig.whiskers[0].shaft.curvature = -0.3;
    for mut world in worlds(&rig, &disks) {
        let sample = last(world.as_mut(), &command(0.0, 0.05, 0.0), 75);
        let [right, left] = [0, 1].map(|whisker: usize| sample.whiskers[whisker].base_angle);
        assert!(right.abs() > 5e-5 && (right + left).abs() < 0.01 * right.abs(), "{right} {left}");
    }
}
