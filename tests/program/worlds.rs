//! Both worlds against each other: the same policy on the same scenes.

use std::sync::Arc;

use vibrissa::built_in::{POLICIES, SCENARIOS};
use vibrissa::diagnostic::Source;
use vibrissa::policy::{compile, gather};
use vibrissa::scenario;
use vibrissa::scene::{Metric, Outcome, Scene, WorldKind};
use vibrissa::trial::{Trial, in_parallel, processors};
use vibrissa_runtime::machine::Program;

/// How far mean errors may be apart (m).
const APART: f64 = 5e-5;

fn thesis() -> Arc<Program> {
    let source = Source::new(POLICIES[0].path, POLICIES[0].text);
    Arc::new(compile(&gather(&source, &mut |path| Err(format!("{path} is not built in")))).unwrap())
}

/// Outcome and mean error (m) of a run.
fn run(scene: &Scene, program: &Arc<Program>, world: WorldKind) -> (Outcome, f64) {
    let trial = Trial { world: world.into(), ..Trial::new(scene.clone(), Arc::clone(program)) };
    let result = trial.run().unwrap();
    (result.run.outcome, result.score.figure(Metric::ErrorMean).unwrap())
}

#[test]
fn the_thesis_policy_does_as_well_in_both_worlds_on_all_scenes() {
    let program = thesis();
    let compared = in_parallel(
        SCENARIOS,
        processors(),
        |file| {
            let scene = scenario::read(&Source::new(file.path, file.text)).unwrap();
            (scene.name.clone(), WorldKind::ALL.map(|world| run(&scene, &program, world)))
        },
        |_| (),
    );
    for (name, [mujoco, quasi_static]) in compared {
        assert_eq!(mujoco.0, quasi_static.0, "{name}");
        let apart = (mujoco.1 - quasi_static.1).abs();
        assert!(apart < APART, "{name}: {:.4} and {:.4} mm", 1e3 * mujoco.1, 1e3 * quasi_static.1);
    }
}
