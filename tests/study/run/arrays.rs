//! Runs of arrays that differ from their models and have calibrated themselves.

use std::path::Path;
use std::sync::Arc;

use vibrissa::built_in::{SCENARIOS, TextFile};
use vibrissa::diagnostic::Source;
use vibrissa::policy::{compile, gather};
use vibrissa::scenario::{self, read_calibration, read_mismatch};
use vibrissa::scene::{Outcome, Scene, WorldKind};
use vibrissa::trial::{Trial, in_parallel, processors};

/// The arrays that `scenarios/mismatch/array.yaml` draws by these seeds, and that of `plausible.yaml`. `tests/fixtures/arrays` has
/// their calibrations, from `vibrissa calibrate --self`.
const SEEDS: [Option<u64>; 11] =
    [None, Some(1), Some(2), Some(3), Some(4), Some(5), Some(6), Some(7), Some(8), Some(9), Some(10)];

fn text(path: &str) -> String {
    std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join(path)).unwrap()
}

/// A built-in scene with a calibrated array.
fn scene(name: &str, seed: Option<u64>) -> Scene {
    let file = TextFile::named(SCENARIOS, Path::new(name)).unwrap();
    let mut scene = scenario::read(&Source::new(file.path, file.text)).unwrap();
    let path = if seed.is_some() { "scenarios/mismatch/array.yaml" } else { "scenarios/mismatch/plausible.yaml" };
    let mut mismatch = read_mismatch(&Source::new(path, text(path))).unwrap();
    mismatch.seed = seed;
    scene.mismatch = Some(mismatch);
    let name = seed.map_or("plausible".to_owned(), |seed| seed.to_string());
    for whisker in &mut scene.rig.whiskers {
        let file = format!("tests/fixtures/arrays/{name}/{}.yaml", whisker.name);
        whisker.calibration = Some(read_calibration(&text(&file)).unwrap());
    }
    scene
}

/// On a convex object no whisker is caught by a surface that turns towards it. The base angle of a whisker that rotates to another
/// posture must not look like that.
#[test]
fn calibrated_arrays_trace_the_disk_in_both_worlds_and_the_box_in_mujoco() {
    // Planar whiskers cannot leave their plane.
    let policy = text("policies/vibrissa.fsm").replace("ribbon    = false", "ribbon    = true");
    let source = Source::new("vibrissa.fsm", policy);
    let program = Arc::new(compile(&gather(&source, &mut |path| Err(format!("{path} is not there")))).unwrap());
    assert_eq!(program.parameters.iter().filter(|parameter| parameter.name == "ribbon").count(), 1);
    let worlds = WorldKind::ALL.into_iter().filter(|kind| cfg!(feature = "sim") || *kind == WorldKind::QuasiStatic);
    let trials: Vec<_> = worlds
        .flat_map(|world| ["disk", "box"].map(|name| (world, name)))
        // Without inertia, some of these arrays lose a wall of the box behind an edge, for another reason.
        .filter(|case| *case != (WorldKind::QuasiStatic, "box"))
        .flat_map(|(world, name)| SEEDS.map(|seed| (world, name, seed)))
        .map(|(world, name, seed)| {
            let mut trial = Trial::new(scene(name, seed), Arc::clone(&program));
            trial.world = world.into();
            (name, format!("{world}, {name}, array {seed:?}"), trial)
        })
        .collect();
    let results = in_parallel(&trials, processors(), |(_, _, trial)| trial.run().unwrap(), |_| ());
    for ((name, case, _), result) in trials.iter().zip(&results) {
        assert_eq!(result.run.outcome, Outcome::Completed, "{case}");
        assert_eq!(result.violations, vec![], "{case}");
        assert_eq!(result.score.collisions.count, 0, "{case}");
        let error = result.score.error.as_ref().unwrap();
        // At a corner, a tip that slips off may be taken for one that still touches. There is none on a disk.
        assert!(*name != "disk" || error.max < 2e-3, "{case}: a tip is {:.2} mm off", error.max * 1e3);
    }
}
