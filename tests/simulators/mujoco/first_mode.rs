//! The first mode of a simulated whisker, measured from its readings after a pluck.

use std::f64::consts::TAU;

use vibrissa::geometry::{Pose, Vector2};
use vibrissa::mujoco::MujocoWorld;
use vibrissa::physics::Physics;
use vibrissa::world::World;
use vibrissa_runtime::rig::Rig;
use vibrissa_runtime::signal::Command;

/// Step (s) of the simulation. At 14 Hz, it adds 0.13 per second to the rate of the decay.
const STEP: f64 = 1.0 / 30_000.0;

/// Readings (rad) of the right whisker, with this first mode (Hz) and decay (s), after the platform has jerked, and their period (s).
fn plucked(first_mode: f64, decay: f64) -> (Vec<f64>, f64) {
    let mut rig = Rig::default();
    rig.platform.servo = 1e-3;
    // The whisker does not swing a platform that is this heavy.
    (rig.platform.mass, rig.platform.inertia) = (100.0, 1.0);
    for whisker in &mut rig.whiskers {
        (whisker.first_mode, whisker.decay) = (Some(first_mode), Some(decay));
    }
    let physics = Physics { step: STEP, calm_step: STEP, rigid_in_air: false, ..Physics::default() };
    let mut world = MujocoWorld::new(&rig, &physics, &[], Pose::default(), 0).unwrap();
    let jerk = Command { velocity_world: Vector2::new(0.1, 0.0), yaw_rate: 0.0 };
    world.advance(&jerk).unwrap();
    // The higher modes decay first.
    (0..3).for_each(|_| assert!(world.advance(&Command::STOP).is_ok()));
    let mut after = |_| world.advance(&Command::STOP).unwrap().to_vec();
    let samples = (0..60).flat_map(&mut after);
    (samples.map(|sample| sample.whiskers[0].base_angle).collect(), rig.sensing.sample_rate.recip())
}

#[test]
fn a_plucked_whisker_swings_with_the_stated_frequency_and_decay() {
    for (first_mode, decay) in [(4.0, 1.0), (8.6, 0.3), (14.0, 0.8)] {
        let (readings, period) = plucked(first_mode, decay);
        let upward = |pair: &[f64]| (pair[0] <= 0.0 && pair[1] > 0.0).then(|| -pair[0] / (pair[1] - pair[0]));
        let crossings: Vec<_> = (0_u32..)
            .zip(readings.windows(2))
            .filter_map(|(index, pair)| Some((f64::from(index) + upward(pair)?) * period))
            .take(4)
            .collect();
        let [first, .., last] = crossings[..] else { panic!("{first_mode} Hz: it does not swing") };
        let count = f64::from(u32::try_from(crossings.len() - 1).unwrap());
        let damped = count / (last - first);
        // The implicit integrator adds the square of the angular frequency times half of a step.
        let rate = 1.0 / decay + (TAU * first_mode).powi(2) * STEP / 2.0;
        let found = (damped * TAU).hypot(rate) / TAU;
        assert!((found / first_mode - 1.0).abs() < 0.01, "{found} Hz of {first_mode} Hz");

        // The energy of the reading in one swing and in a later one.
        let swing = |start: f64| {
            let inside = |index: u32| (start..start + 1.0 / damped).contains(&(f64::from(index) * period));
            let inside = (0_u32..).zip(&readings).filter(|(index, _)| inside(*index));
            inside.map(|(_, reading)| reading * reading).sum::<f64>()
        };
        let found = (swing(first) / swing(last)).ln() / (2.0 * (last - first));
        assert!((found / rate - 1.0).abs() < 0.05, "{found} and {rate} per second");
    }
}

#[test]
fn a_strongly_damped_whisker_creeps_back() {
    let (first_mode, decay) = (8.0, 5e-3);
    let (readings, period) = plucked(first_mode, decay);
    let frequency = TAU * first_mode;
    let rate = 1.0 / decay - (1.0 / (decay * decay) - frequency * frequency).sqrt();
    let found = (readings[30] / readings[90]).ln() / (60.0 * period);
    assert!((found / rate - 1.0).abs() < 0.05, "{found} and {rate} per second");
}
