//! The runs of the bench: every scene under every built-in policy in every world.

use std::sync::{Arc, LazyLock};

use vibrissa::built_in::{POLICIES, SCENARIOS, TextFile};
use vibrissa::diagnostic::Source;
use vibrissa::policy::{compile, gather};
use vibrissa::results::RunResult;
use vibrissa::scenario;
use vibrissa::scene::{Jitter, WorldKind};
use vibrissa::trial::{Trial, in_parallel, processors};
use vibrissa_runtime::machine::Program;

/// The displacement of a start: large enough that rounding decides nothing, and too small to make it another scene.
const JITTER: Jitter = Jitter { position: 2e-4, heading: 0.2_f64.to_radians() };
/// The seeds of the displaced starts.
const SEEDS: std::ops::RangeInclusive<u64> = 1..=6;

/// The trials with their results. Several tests read them, and they run once.
pub(crate) static RUNS: LazyLock<Vec<(Trial, RunResult)>> = LazyLock::new(|| {
    let programs: Vec<_> = POLICIES.iter().map(program).collect();
    let scenes: Vec<_> =
        SCENARIOS.iter().map(|file| scenario::read(&Source::new(file.path, file.text)).unwrap()).collect();
    let settings = programs.iter().flat_map(|program| WorldKind::ALL.map(|world| (program, world)));
    let trials: Vec<_> = settings
        .flat_map(|(program, world)| {
            let trial = move |scene| Trial { world: world.into(), ..Trial::new(scene, Arc::clone(program)) };
            scenes.iter().cloned().map(trial)
        })
        .collect();
    let results = run_all(&trials);
    trials.into_iter().zip(results).collect()
});

/// The results of a trial from all displaced starts.
pub(super) fn displaced(trial: &Trial) -> Vec<RunResult> {
    let from = |seed| {
        let mut trial = trial.clone();
        trial.scene.start = JITTER.start(&trial.scene, seed).unwrap();
        trial
    };
    run_all(&SEEDS.map(from).collect::<Vec<_>>())
}

fn run_all(trials: &[Trial]) -> Vec<RunResult> {
    in_parallel(trials, processors(), |trial| trial.document(&trial.run().unwrap()), |_| ())
}

fn program(file: &TextFile) -> Arc<Program> {
    let source = Source::new(file.path, file.text);
    Arc::new(compile(&gather(&source, &mut |path| Err(format!("{path} is not built in")))).unwrap())
}
