//! Runs around objects that overlap.

use std::sync::Arc;

use vibrissa::built_in::DEFAULT_POLICY;
use vibrissa::diagnostic::Source;
use vibrissa::figures::Metric;
use vibrissa::policy::{compile, gather};
use vibrissa::scenario;
use vibrissa::scene::{Outcome, Scene, WorldKind};
use vibrissa::trial::{Trial, TrialResult};

/// Two boxes, the second of which reaches on from within the first; together they are the box of the bench.
const OVERLAPPING: &str = "
  - rectangle: {centre: [0.221519 m, 0.182635 m], width: 0.2 m, height: 0.4 m, heading: 10 deg}
  - rectangle: {centre: [0.369240 m, 0.208682 m], width: 0.3 m, height: 0.4 m, heading: 10 deg}";

fn scene(objects: &str) -> Scene {
    let text = format!(
        "name: boxes\nrig: {{physics: {{step: 0.5556 ms, contact_time: 1.25 ms}}}}\nobjects:{objects}\n\
         start: {{position: [0 m, 72 mm], heading: 90 deg}}\n\
         stop: {{time: 240 s, loop_closed: {{within: 5 mm, after: 5 s}}}}\n"
    );
    scenario::read(&Source::new("boxes.yaml", text)).unwrap()
}

fn is_traced_as_one(world: WorldKind) {
    let scene = scene(OVERLAPPING);
    assert_eq!((scene.solids.len(), scene.truth.reference.contours().count()), (1, 1));
    let source = Source::new(DEFAULT_POLICY.path, DEFAULT_POLICY.text);
    let program = Arc::new(compile(&gather(&source, &mut |path| Err(format!("{path} is not built in")))).unwrap());
    let trial = Trial { world: world.into(), seed: 0, ..Trial::new(scene, program) };
    let TrialResult { run, score, .. } = trial.run().unwrap();
    assert_eq!(run.outcome, Outcome::Completed);
    // Once round the outline of both, and never along a side that is within the other.
    assert!(score.figure(Metric::Coverage).unwrap() > 0.97);
    assert!(score.figure(Metric::ErrorMax).unwrap() < 1e-3);
}

#[test]
fn boxes_that_overlap_are_traced_as_one_in_the_quasi_static_world() {
    is_traced_as_one(WorldKind::QuasiStatic);
}

#[cfg(feature = "sim")]
#[test]
fn boxes_that_overlap_are_traced_as_one_in_mujoco() {
    is_traced_as_one(WorldKind::Mujoco);
}
