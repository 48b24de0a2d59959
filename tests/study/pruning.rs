//! What is left out of a run changes nothing.

use std::ops::ControlFlow;
use std::sync::Arc;

use vibrissa::diagnostic::Source;
use vibrissa::geometry::Point2;
use vibrissa::machine::Program;
use vibrissa::policy::{compile, gather};
use vibrissa::scene::family::{Draw, FAMILIES};
use vibrissa::scene::{Scene, WorldKind, WorldSetup};
use vibrissa::study::bench::POLICIES;
use vibrissa::study::{execute, in_parallel, processors};
use vibrissa::units::Dimension;

/// How far a point of the estimated contour may move (m).
const SAME: f64 = 1e-6;

fn thesis() -> Program {
    let source = Source::new(POLICIES[0].path, POLICIES[0].text);
    compile(&gather(&source, &mut |path| Err(format!("{path} is not built in")))).unwrap()
}

/// All points of the estimated contours of a run, in the order in which they were recorded.
fn contour(scene: &Scene, program: &Program, prune: bool) -> Vec<Point2> {
    let world = WorldSetup { kind: WorldKind::Mujoco, prune };
    let run = execute(scene, Arc::new(program.clone()), world, scene.seed, |_| ControlFlow::Continue(())).unwrap();
    run.trace.ticks.iter().flat_map(|tick| tick.tips.into_iter().flatten()).collect()
}

/// Runs that many scenes of every family for so long (s), with and without; how many points there were.
fn compare(trials: u64, time: f64) -> usize {
    let policy = thesis();
    let keys: Vec<_> = FAMILIES.iter().flat_map(|family| (0..trials).map(move |trial| (family, trial))).collect();
    let counts = in_parallel(
        &keys,
        processors(),
        |(family, trial)| {
            let Draw { mut scene, speed, .. } = family.draw(8, *trial).unwrap();
            scene.stop.time = time;
            let mut program = policy.clone();
            program.set("speed", speed, Dimension::SPEED).unwrap();
            let [pruned, whole] = [true, false].map(|prune| contour(&scene, &program, prune));
            assert_eq!(pruned.len(), whole.len(), "{}", scene.name);
            for (a, b) in pruned.iter().zip(&whole) {
                assert!((a - b).norm() < SAME, "{}: {a} and {b}", scene.name);
            }
            pruned.len()
        },
        |_| (),
    );
    counts.into_iter().sum()
}

#[test]
fn pruning_does_not_change_the_estimated_contour() {
    assert!(compare(1, 12.0) > 100);
}

#[test]
#[ignore = "takes minutes; `cargo test --release --test study pruning -- --ignored` runs it"]
fn pruning_does_not_change_the_estimated_contour_of_hundreds_of_scenes() {
    assert!(compare(30, 20.0) > 10_000);
}
