//! Runs under a policy that has the true tips.

use std::sync::Arc;

use vibrissa::built_in::SCENARIOS;
use vibrissa::diagnostic::Source;
use vibrissa::figures::Metric;
use vibrissa::policy::{compile, gather};
use vibrissa::report::{picture, results_table};
use vibrissa::scenario;
use vibrissa::scene::{Outcome, WorldKind};
use vibrissa::trial::Trial;

/// `thesis.fsm` with another contact estimator on the disk, in the quasi-static world.
fn trial(estimator: &str) -> Trial {
    trial_in(0, estimator)
}

/// The same in another one of the ten scenes.
fn trial_in(scene: usize, estimator: &str) -> Trial {
    let text = include_str!("../../../policies/thesis.fsm").replace("by one_channel", &format!("by {estimator}"));
    let source = Source::new("thesis.fsm", text);
    let program = compile(&gather(&source, &mut |path| Err(format!("{path} is not there")))).unwrap();
    let scene = SCENARIOS[scene];
    let scene = scenario::read(&Source::new(scene.path, scene.text)).unwrap();
    let mut trial = Trial::new(scene, Arc::new(program));
    trial.world = WorldKind::QuasiStatic.into();
    trial
}

#[test]
fn every_recorded_tip_is_the_true_one_and_the_result_says_so() {
    let trial = trial("truth");
    let result = trial.run().unwrap();
    assert_eq!(result.run.outcome, Outcome::Completed, "{:?}", result.run.reason);
    let document = trial.document(&result);
    let figure = |metric| document.figure(metric).unwrap();
    assert!(document.true_tips && figure(Metric::Tips) > 500.0);
    // The score computes the true tips by itself.
    let off = [Metric::AlongMax, Metric::AcrossMax].map(figure);
    assert!(off.iter().all(|off| *off < 1e-9), "{off:?}");
    assert!(figure(Metric::ErrorMax) < 1e-3 && document.figure(Metric::IntervalCoverage) == Some(1.0));
    let table = results_table(std::slice::from_ref(&document)).wide();
    assert!(table.contains("(true tips)"), "{table}");
    let picture = picture(&trial.scene, &trial.policy_label(), &result.run, &result.score);
    assert!(picture.contains("(true tips)"));
}

#[test]
fn a_tip_that_springs_off_an_edge_is_not_taken_for_the_edge() {
    for scene in 0..SCENARIOS.len() {
        let trial = trial_in(scene, "truth");
        let result = trial.run().unwrap();
        assert_eq!(result.run.outcome, Outcome::Completed, "{}: {:?}", trial.scene.name, result.run.reason);
    }
}

#[test]
fn samples_have_true_tips_only_if_they_are_asked_for() {
    let mut trial = trial("one_channel");
    trial.scene.stop.time = 2.0;
    let has_any = |trial: &Trial| {
        let recording = trial.record().unwrap();
        recording.ticks.iter().flatten().flat_map(|sample| sample.whiskers).any(|reading| reading.true_tip.is_some())
    };
    assert!(!has_any(&trial));
    let without = trial.run().unwrap();
    let document = trial.document(&without);
    assert!(!document.true_tips && !results_table(&[document]).wide().contains("true tips"));
    trial.true_tips = true;
    assert!(has_any(&trial));
    // An estimator that does not ask for them does not use them.
    let with = trial.run().unwrap();
    assert!(without.run.trace.ticks == with.run.trace.ticks);
}
