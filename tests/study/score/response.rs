//! Whiskers whose readings do not follow their bends.

use std::sync::Arc;

use vibrissa::built_in::{DEFAULT_POLICY, POLICIES, SCENARIOS};
use vibrissa::diagnostic::Source;
use vibrissa::geometry::Point2;
use vibrissa::run::Run;
use vibrissa::scene::{Scene, WorldKind};
use vibrissa::score::{Response, responses};
use vibrissa::trial::Trial;
use vibrissa::{policy, scenario};
use vibrissa_runtime::machine::Program;
use vibrissa_runtime::rig::Rig;

use crate::runs::run_with;

/// A run in which the true tip of r0 swings about its straight shaft by up to `most` (rad), and the perceived one by the
/// given function of the true bend.
fn swung(most: f64, perceived: impl Fn(f64) -> Option<f64>) -> (Run, Rig) {
    let rig = Rig::default();
    let whisker = rig.whiskers.iter().find(|whisker| whisker.name == "r0").unwrap();
    let mut run = run_with(&[vec![None; 90]]);
    run.trace.whiskers = vec!["r0".to_owned()];
    for (index, tick) in run.trace.ticks.iter_mut().enumerate() {
        let tip = |bend: f64| {
            let direction = whisker.direction_body + bend;
            let [x, y] = [direction.cos(), direction.sin()].map(|part| whisker.shaft.length * part);
            tick.body.point_to_world(Point2::new(whisker.base_body.x + x, whisker.base_body.y + y))
        };
        let bend = most * (0.2 * index as f64).sin();
        tick.whiskers[0].tip_end = Some(tip(bend));
        tick.whiskers[0].contact.tip_world = perceived(bend).map(tip);
    }
    (run, rig)
}

fn response(most: f64, perceived: impl Fn(f64) -> Option<f64>) -> Response {
    let (run, rig) = swung(most, perceived);
    responses(&run.trace, &rig)[0]
}

#[test]
fn the_response_is_the_factor_of_the_bend_and_a_constant_error_changes_nothing() {
    for (gain, is_dead) in [(1.0, false), (0.8, false), (0.6, false), (0.4, true), (0.1, true), (-1.0, true)] {
        for offset in [0.0, 0.3] {
            let found = response(0.5, |bend| Some(gain * bend + offset));
            assert!((found.slope.unwrap() - gain).abs() < 1e-9, "{found:?}");
            assert_eq!(found.is_dead(), is_dead, "{gain}");
        }
    }
}

#[test]
fn a_reading_that_stands_still_or_is_none_is_dead_and_a_whisker_that_was_hardly_bent_is_not_judged() {
    assert_eq!(response(0.5, |_| Some(0.2)).slope.map(f64::abs).filter(|slope| *slope < 1e-9).map(|_| ()), Some(()));
    assert!(response(0.5, |_| None).is_dead());
    // A lost reading now and then is not a dead whisker.
    assert!(!response(0.5, |bend| (bend.to_bits() % 4 != 0).then_some(bend)).is_dead());
    let straight = response(0.09, |_| Some(0.0));
    assert_eq!((straight.bent_time, straight.slope, straight.is_dead()), (0.0, None, false));
}

fn program(path: &str) -> Arc<Program> {
    let file = POLICIES.iter().find(|file| file.path == path).unwrap();
    let source = Source::new(file.path, file.text);
    let source = policy::gather(&source, &mut |path| Err(format!("{path} is not built in")));
    Arc::new(policy::compile(&source).unwrap())
}

fn scene(name: &str, mismatch: &str) -> Scene {
    let file = SCENARIOS.iter().find(|file| file.path == format!("scenarios/{name}.yaml")).unwrap();
    scenario::read(&Source::new(file.path, format!("{}\n{mismatch}", file.text))).unwrap()
}

/// The whiskers that seem dead in a run in the quasi-static world.
fn dead(scene: Scene, program: &Arc<Program>) -> Vec<String> {
    let trial = Trial { world: WorldKind::QuasiStatic.into(), ..Trial::new(scene, Arc::clone(program)) };
    let result = trial.run().unwrap();
    trial.document(&result).dead_whiskers().map(|whisker| whisker.whisker.clone()).collect()
}

#[test]
fn a_whisker_that_lost_nine_tenths_of_its_gain_is_named_and_no_other_one() {
    let program = program(DEFAULT_POLICY.path);
    for (name, gain) in [("r0", "-90 %"), ("r0", "-70 %"), ("l0", "-90 %")] {
        let mismatch = format!("mismatch: {{whiskers: {{{name}: {{sensor: {{gain: {gain}}}}}}}}}");
        assert_eq!(dead(scene("round-tunnel", &mismatch), &program), [name], "{gain}");
    }
    // The errors of an array that nobody has calibrated are no dead whisker.
    for gain in ["-20 %", "20 %"] {
        let mismatch = format!("mismatch: {{sensor: {{gain: {gain}}}}}");
        assert!(dead(scene("round-tunnel", &mismatch), &program).is_empty(), "{gain}");
    }
}
