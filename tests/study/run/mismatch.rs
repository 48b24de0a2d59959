//! Runs whose true array is not the assumed one.

use std::sync::Arc;

use vibrissa::built_in::SCENARIOS;
use vibrissa::diagnostic::Source;
use vibrissa::mismatch::{Difference, Mismatch, Property, Range};
use vibrissa::policy::{compile, gather};
use vibrissa::run::TickRecord;
use vibrissa::scenario;
use vibrissa::scene::WorldKind;
use vibrissa::trial::Trial;

/// `thesis.fsm` for some seconds on the disk.
fn trial(world: WorldKind) -> Trial {
    let source = Source::new("thesis.fsm", include_str!("../../../policies/thesis.fsm"));
    let program = compile(&gather(&source, &mut |path| Err(format!("{path} is not there")))).unwrap();
    let disk = SCENARIOS[0];
    let mut scene = scenario::read(&Source::new(disk.path, disk.text)).unwrap();
    scene.stop.time = 15.0;
    let mut trial = Trial::new(scene, Arc::new(program));
    trial.world = world.into();
    trial
}

/// The worlds of this build.
fn worlds() -> impl Iterator<Item = WorldKind> {
    WorldKind::ALL.into_iter().filter(|kind| cfg!(feature = "sim") || *kind == WorldKind::QuasiStatic)
}

fn with(values: &[(Property, Range)]) -> Mismatch {
    let mut mismatch = Mismatch::default();
    for &(property, range) in values {
        mismatch.common.set(property, range);
    }
    mismatch
}

/// Everything that a tick records, bit by bit.
fn bits(ticks: &[TickRecord]) -> Vec<String> {
    ticks.iter().map(|tick| format!("{tick:?}")).collect()
}

fn run(trial: &Trial, mismatch: Option<Mismatch>) -> Vec<String> {
    let mut trial = trial.clone();
    trial.scene.mismatch = mismatch;
    let ticks = trial.run().unwrap().run.trace.ticks;
    assert!(ticks.len() > 400);
    bits(&ticks)
}

#[test]
fn a_mismatch_of_nothing_changes_no_bit() {
    for world in worlds() {
        let trial = trial(world);
        let none = run(&trial, None);
        assert_eq!(none, run(&trial, Some(Mismatch::default())), "{world}");
        let is_absolute = |property| matches!(property, Property::Links | Property::Servo | Property::WanderTime);
        let zero =
            Difference::all().filter(|difference| !is_absolute(difference.property) && !difference.is_logarithmic());
        let zero: Vec<_> = zero.map(|difference| (difference.property, 0.0.into())).collect();
        assert_eq!(none, run(&trial, Some(with(&zero))), "{world}");
    }
}

/// The wrapper of a world adds nothing of its own: with a latency that is shorter than any rounding, all samples are exact.
#[test]
fn samples_without_errors_pass_unchanged() {
    for world in worlds() {
        let trial = trial(world);
        let almost = with(&[(Property::Gain, 1e-300.into())]);
        assert!(!almost.array(&trial.scene.rig).is_measured_exactly());
        assert_eq!(run(&trial, None), run(&trial, Some(almost)), "{world}");
    }
}

#[test]
fn the_true_rig_is_simulated_and_control_assumes_that_of_the_scene() {
    let mismatch = with(&[
        (Property::Stiffness, 0.05.into()),
        (Property::Direction, 0.02.into()),
        (Property::TipAside, 1e-3.into()),
        (Property::Servo, 0.1.into()),
    ]);
    for world in worlds() {
        let trial = trial(world);
        let mut other = trial.clone();
        other.scene.rig = mismatch.array(&trial.scene.rig).rig;
        let found = run(&trial, Some(mismatch.clone()));
        assert_eq!(found, run(&other, None), "{world}");
        assert_ne!(found, run(&trial, None), "{world}");
    }
}

#[test]
fn a_run_repeats_itself_and_depends_on_both_seeds() {
    let drawn = |seed| Mismatch {
        seed: Some(seed),
        ..with(&[(Property::Stiffness, Range { least: -0.05, greatest: 0.05 }), (Property::PoseNoise, 1e-5.into())])
    };
    let trial = trial(WorldKind::QuasiStatic);
    let first = run(&trial, Some(drawn(1)));
    assert_eq!(first, run(&trial, Some(drawn(1))));
    assert_ne!(first, run(&trial, Some(drawn(2))));
    assert_ne!(first, run(&Trial { seed: 1, ..trial }, Some(drawn(1))));
}

#[test]
fn an_offset_is_a_bias_and_noise_is_scatter() {
    let trial = trial(WorldKind::QuasiStatic);
    let error = |property, value: f64| {
        let mut trial = trial.clone();
        trial.scene.mismatch = Some(with(&[(property, value.into())]));
        let error = trial.run().unwrap().score.error.unwrap();
        (error.bias.unwrap(), error.scatter.unwrap())
    };
    let (offset, noise) = (error(Property::Offset, 10e-6), error(Property::PoseNoise, 0.3e-3));
    assert!(offset.0 > 0.2e-3 && offset.1 < 0.3 * offset.0, "{offset:?}");
    assert!(noise.1 > 0.1e-3 && noise.0 < 0.3 * noise.1, "{noise:?}");
}
