//! The energy of a free whisker.

use vibrissa::geometry::{Pose, Vector2};
use vibrissa::mujoco::MujocoWorld;
use vibrissa::physics::Integrator;
use vibrissa::physics::Physics;
use vibrissa::world::World;
use vibrissa_runtime::rig::Rig;
use vibrissa_runtime::signal::Command;

/// Energies (J), tick by tick, of a rig that was shaken and is then left to itself, its servos braking.
fn energies((rig, physics): &(Rig, Physics)) -> Vec<f64> {
    let mut world = MujocoWorld::new(rig, physics, &[], Pose::default(), 0).unwrap();
    for way in [1.0, -1.0, 1.0] {
        let shake = Command { velocity_world: Vector2::new(0.3 * way, 0.2), yaw_rate: 3.0 * way };
        (0..2).for_each(|_| assert!(world.advance(&shake).is_ok()));
    }
    let mut after = |_| {
        world.advance(&Command::STOP).unwrap();
        world.energy().unwrap()
    };
    (0..60).map(&mut after).collect()
}

fn rig(step: f64, links: usize, stiffness: f64, damping: f64) -> (Rig, Physics) {
    let mut rig = Rig::default();
    rig.sensing.sample_rate = rig.sensing.sample_rate.min(step.recip());
    for whisker in &mut rig.whiskers {
        whisker.shaft.links = links;
        whisker.shaft.young_modulus *= stiffness;
        whisker.shaft.damping *= damping;
        whisker.hinge.damping *= damping;
    }
    (rig, Physics { step, ..Physics::default() })
}

#[test]
fn the_energy_of_a_free_whisker_never_grows() {
    for step in [1.0 / 1500.0, 1.0 / 300.0, 1.0 / 30.0] {
        for (links, stiffness, damping) in [(16, 1.0, 1.0), (4, 0.01, 1.0), (40, 100.0, 1.0), (16, 1.0, 0.0)] {
            let energies = energies(&rig(step, links, stiffness, damping));
            let first = energies[0];
            assert!(first > 1e-6, "{first} J: it was shaken");
            for (tick, pair) in energies.windows(2).enumerate() {
                let grown = pair[1] - pair[0];
                assert!(grown <= 1e-9 * first, "{step} s, {links} links: {grown} J of {first} J more at tick {tick}");
            }
        }
    }
}

/// The check can fail: an explicit integrator, which has no stable step as long as that, gains energy or diverges.
#[test]
fn an_integrator_that_is_not_stable_gains_energy_or_says_so() {
    let (rig, mut physics) = rig(1.0 / 300.0, 16, 1.0, 0.0);
    physics.integrator = Integrator::Euler;
    let mut world = MujocoWorld::new(&rig, &physics, &[], Pose::default(), 0).unwrap();
    let shake = Command { velocity_world: Vector2::new(0.3, 0.0), yaw_rate: 3.0 };
    let mut before = f64::INFINITY;
    let gained = (0..60).any(|tick| {
        let command = if tick < 2 { shake } else { Command::STOP };
        let is_lost = world.advance(&command).is_err();
        let energy = world.energy().unwrap();
        let gains = tick > 2 && energy > before;
        before = energy;
        is_lost || gains
    });
    assert!(gained);
}
