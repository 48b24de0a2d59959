//! Rough surfaces in both simulators.

use std::sync::Arc;

use vibrissa::built_in::POLICIES;
use vibrissa::diagnostic::Source;
use vibrissa::policy::{compile, gather};
use vibrissa::scenario;
use vibrissa::scene::{Scene, WorldKind};
use vibrissa::trial::Trial;

const ROUGH_DISK: &str = include_str!("../../scenarios/more/rough-disk.yaml");

fn scene(text: &str) -> Scene {
    scenario::read(&Source::new("rough-disk.yaml", text)).unwrap()
}

/// The share of tips whose error is within their interval, for `vibrissa.fsm` in the quasi-static simulator.
fn interval_coverage(scene: Scene) -> f64 {
    let source = POLICIES.iter().find(|policy| policy.path.ends_with("vibrissa.fsm")).unwrap();
    let files = gather(&Source::new(source.path, source.text), &mut |path| Err(format!("{path} is not built in")));
    let program = Arc::new(compile(&files).unwrap());
    let trial = Trial { world: WorldKind::QuasiStatic.into(), ..Trial::new(scene, program) };
    trial.run().unwrap().score.error.unwrap().interval_coverage
}

#[test]
fn intervals_contain_a_texture_if_the_rig_states_its_roughness() {
    let texture = "amplitude: 0.2 mm, wavelength: 20 mm";
    let text = ROUGH_DISK.replace("amplitude: 0.05 mm, wavelength: 10 mm", texture);
    let [known, unknown] = [2e-4, 0.0].map(|assumed| {
        let mut scene = scene(&text);
        scene.rig.sensing.surface_roughness = assumed;
        interval_coverage(scene)
    });
    assert!(known > 0.93 && unknown < 0.8, "{known} and {unknown}");
}

#[test]
fn the_reference_of_the_score_has_no_texture() {
    let rough = scene(ROUGH_DISK);
    let texture = ROUGH_DISK.lines().find(|line| line.trim_start().starts_with("texture:")).unwrap();
    let smooth = scene(&ROUGH_DISK.replace(texture, ""));
    for (rough, smooth) in
        [(&rough.truth.reference, &smooth.truth.reference), (&rough.truth.surfaces, &smooth.truth.surfaces)]
    {
        assert_eq!(rough.length().to_bits(), smooth.length().to_bits());
    }
    assert!(rough.surfaces().length() > smooth.surfaces().length());
}

#[cfg(feature = "sim")]
mod worlds {
    use std::f64::consts::FRAC_PI_2;

    use vibrissa::geometry::{Point2, Pose, Texture, TextureKind, Vector2, polygon};
    use vibrissa::mujoco::MujocoWorld;
    use vibrissa::physics::Physics;
    use vibrissa::quasi_static::QuasiStaticWorld;
    use vibrissa::solid::Solid;
    use vibrissa::world::World;
    use vibrissa_runtime::rig::Rig;
    use vibrissa_runtime::signal::Command;

    /// The largest difference of the two simulators, as a share of the effect of the texture.
    const SHARE: f64 = 0.2;

    /// The platform approaches a wall on its right for 1.4 s, and then moves along it.
    fn base_angles(world: &mut dyn World) -> Vec<f64> {
        let mut angles = Vec::new();
        for (velocity, ticks) in [(Vector2::new(0.02, 0.05), 42), (Vector2::new(0.0, 0.05), 90)] {
            for _ in 0..ticks {
                let samples = world.advance(&Command { velocity_world: velocity, yaw_rate: 0.0 }).unwrap();
                angles.extend(samples.iter().map(|sample| sample.whiskers[0].base_angle));
            }
        }
        // The last two seconds.
        angles.split_off(angles.len() - 600)
    }

    fn rms_difference(one: &[f64], other: &[f64]) -> f64 {
        let squares = one.iter().zip(other).map(|(one, other)| (one - other).powi(2));
        (squares.sum::<f64>() / one.len() as f64).sqrt()
    }

    #[test]
    fn both_simulators_give_a_texture_the_same_effect() {
        let mut rig = Rig::default();
        rig.whiskers.truncate(1);
        // The platform hardly yields to forces, so that both follow the same path.
        (rig.platform.mass, rig.platform.inertia, rig.platform.servo) = (50.0, 0.15, 5e-3);
        let stiff = [0.99, 0.999, 1e-5];
        let physics =
            Physics { step: 1.0 / 3600.0, contact_time: 6e-4, contact_impedance: stiff, ..Physics::default() };
        let start = Pose { position: Point2::new(-0.03, 0.0), heading: FRAC_PI_2 };
        let corners = [(0.1, -0.1), (0.12, -0.1), (0.12, 0.3), (0.1, 0.3)].map(|(x, y)| Point2::new(x, y));
        let wall = polygon(&corners).unwrap();
        let smooth = [Solid::inside(wall.clone()).unwrap()];
        let quasi_static =
            |solids: &[Solid]| base_angles(&mut QuasiStaticWorld::new(&rig, &physics, solids, start, 0).unwrap());
        for kind in TextureKind::ALL {
            let texture = Texture { kind, amplitude: 5e-5, wavelength: 8e-3, seed: 1 };
            let rough = [Solid::textured(wall.clone(), &texture).unwrap()];
            let exact = quasi_static(&rough);
            let effect = rms_difference(&exact, &quasi_static(&smooth));
            let mujoco = base_angles(&mut MujocoWorld::pruned(&rig, &physics, &rough, start, 0).unwrap());
            let difference = rms_difference(&exact, &mujoco);
            assert!(effect > 1e-6 && difference < SHARE * effect, "{kind:?}: {difference} of {effect} rad");
        }
    }
}
