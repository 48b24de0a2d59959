//! What every world owes a loop.

use vibrissa::physics::Physics;
use vibrissa::quasi_static::{QuasiStaticError, QuasiStaticWorld};
use vibrissa::world::{Fault, World};
use vibrissa_runtime::rig::Rig;
use vibrissa_runtime::signal::Command;

use super::scene::{START, command, drive, one_whisker, outlines, solids};

fn disk() -> Vec<vibrissa::solid::Solid> {
    solids([outlines().swap_remove(0).1])
}

#[test]
fn servos_follow_a_command_with_their_time_constant() {
    let rig = Rig::default();
    let mut world = QuasiStaticWorld::new(&rig, &Physics::default(), &[], START, 0).unwrap();
    let servo = rig.platform.servo;
    for _ in 0..60 {
        for sample in world.advance(&command(0.03, -0.02, 0.5)).unwrap() {
            let travelled = sample.time - servo * (1.0 - (-sample.time / servo).exp());
            let way = vibrissa::geometry::Vector2::new(0.03, -0.02) * travelled;
            assert!((sample.body.position - START.position - way).norm() < 1e-14, "at {} s", sample.time);
            assert!((sample.body.heading - START.heading - 0.5 * travelled).abs() < 1e-13);
        }
    }
}

#[test]
fn a_tick_gives_one_sample_a_sample_period() {
    let mut world = QuasiStaticWorld::new(&Rig::default(), &Physics::default(), &[], START, 0).unwrap();
    let mut times = Vec::new();
    for _ in 0..3 {
        times.extend(world.advance(&Command::STOP).unwrap().iter().map(|sample| sample.time));
    }
    assert_eq!(times.len(), 30);
    for (index, time) in times.iter().enumerate() {
        assert!((time - (index + 1) as f64 / 300.0).abs() < 1e-12);
    }
}

#[test]
fn the_same_seed_gives_the_same_samples_and_another_seed_other_noise() {
    let mut rig = Rig::default();
    (rig.sensing.angle_noise, rig.sensing.angle_resolution) = (1e-6, 2e-7);
    let run = |seed| {
        let mut world = QuasiStaticWorld::new(&rig, &Physics::default(), &disk(), START, seed).unwrap();
        drive(&mut world, &command(0.01, 0.05, -0.1), 100).unwrap()
    };
    assert_eq!(run(1), run(1));
    assert_ne!(run(1).whiskers, run(2).whiskers);
    let steps = run(1).whiskers[0].base_angle / 2e-7;
    assert!((steps - steps.round()).abs() < 1e-9);
}

#[test]
fn a_base_angle_is_late_by_the_hinges_time_constant() {
    let reading = |damping: f64, ticks: usize| {
        let mut rig = one_whisker();
        rig.whiskers[0].hinge.damping = damping;
        let mut world = QuasiStaticWorld::new(&rig, &Physics::default(), &disk(), START, 0).unwrap();
        drive(&mut world, &command(0.0, 0.05, 0.0), ticks).unwrap().whiskers[0].base_angle
    };
    // A third of a tick at a time, the readings with a damper are those without it, earlier by 10 ms: three samples.
    let mut rig = one_whisker();
    rig.whiskers[0].hinge.damping = 0.0;
    let mut world = QuasiStaticWorld::new(&rig, &Physics::default(), &disk(), START, 0).unwrap();
    let mut free = Vec::new();
    for _ in 0..75 {
        free.extend(
            world.advance(&command(0.0, 0.05, 0.0)).unwrap().iter().map(|sample| sample.whiskers[0].base_angle),
        );
    }
    let late = reading(0.01, 75);
    assert!(late.abs() > 3e-5, "{late}");
    assert!((late / free[free.len() - 4] - 1.0).abs() < 3e-3, "{late} against {}", free[free.len() - 4]);
}

#[test]
fn a_start_in_a_solid_is_told_before_a_run() {
    let mut there = START;
    there.position.x = 0.05;
    let refused =
        QuasiStaticWorld::new(&Rig::default(), &Physics::default(), &disk(), there, 0).map(|_| ()).unwrap_err();
    assert_eq!(refused, QuasiStaticError::Start { part: "the whisker `r0`".to_owned() });
}

#[test]
fn absurd_commands_end_in_a_typed_fault_or_in_numbers() {
    for (x, yaw) in [(f64::NAN, 0.0), (0.0, f64::INFINITY), (1e9, 0.0), (1.0, 1e6), (-3.0, 40.0)] {
        let mut world = QuasiStaticWorld::new(&one_whisker(), &Physics::default(), &disk(), START, 0).unwrap();
        for _ in 0..60 {
            match world.advance(&command(x, 0.05, yaw)) {
                Ok(samples) => assert!(samples.iter().all(|sample| sample.whiskers[0].base_angle.is_finite())),
                Err(fault) => {
                    assert!(!x.is_finite() || !matches!(fault, Fault::Diverged { .. }) || yaw > 30.0, "{fault}");
                    break;
                }
            }
        }
    }
}

#[test]
fn a_whisker_that_slips_off_a_corner_springs_and_one_that_slides_does_not() {
    let corners = [(0.1, 0.16), (0.2, 0.16), (0.2, 0.21), (0.1, 0.21)];
    let block = solids([vibrissa::geometry::polygon(&super::scene::points(&corners)).unwrap()]);
    let rig = one_whisker();
    // A whisker that slips off needs short steps.
    let physics = Physics { step: 1.0 / 1800.0, contact_time: 1.25e-3, ..Physics::default() };
    let ticks_that_spring = |solids: &[vibrissa::solid::Solid]| {
        let mut worlds: Vec<Box<dyn World>> =
            vec![Box::new(QuasiStaticWorld::new(&rig, &physics, solids, START, 0).unwrap())];
        #[cfg(feature = "sim")]
        worlds.push(Box::new(vibrissa::mujoco::MujocoWorld::pruned(&rig, &physics, solids, START, 0).unwrap()));
        let count = |world: &mut Box<dyn World>| {
            let ticks = (0..150).filter(|_| {
                world.advance(&command(0.0, 0.05, 0.0)).unwrap();
                world.snapped_off(0)
            });
            ticks.count()
        };
        worlds.iter_mut().map(count).collect::<Vec<_>>()
    };
    assert!(ticks_that_spring(&block).into_iter().all(|ticks| (1..20).contains(&ticks)));
    assert!(ticks_that_spring(&disk()).into_iter().all(|ticks| ticks == 0));
}
