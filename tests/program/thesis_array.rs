//! Policies with the array of the thesis, whose whiskers point forward.

use std::path::Path;
use std::process::Command;
use std::thread;

use serde_json::Value;

const SCENES: [&str; 5] = ["disk", "octagon", "box", "wall", "smooth-tunnel"];

/// The runs of a policy in all scenes.
fn runs(policy: &str, world: &str) -> Vec<Value> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let scenes = SCENES.map(|scene| root.join(format!("scenarios/more/thesis-array-{scene}.yaml")));
    let policy = root.join(format!("policies/{policy}.fsm"));
    let mut command = Command::new(env!("CARGO_BIN_EXE_vibrissa"));
    let output = command.arg("run").args(scenes).arg("--policy").arg(policy).args(["--simulator", world, "--json"]);
    let runs: Vec<Value> = serde_json::from_slice(&output.output().unwrap().stdout).unwrap();
    assert_eq!(runs.len(), SCENES.len());
    runs
}

/// Every scene completes without a contact of the body, with a mean error (mm) and a coverage within these bounds. In the
/// tunnel the array follows one wall, so the share of the passage counts.
fn completes_all(policy: &str, error_mm: f64, coverage: f64) {
    thread::scope(|scope| {
        for world in ["mujoco", "quasistatic"] {
            scope.spawn(move || {
                for run in runs(policy, world) {
                    let name = format!("{} in {world}: {}", run["scenario"], run["reason"]);
                    assert_eq!(run["outcome"], "completed", "{name}");
                    assert_eq!(run["collisions"]["count"], 0, "{name}");
                    let mean = run["error_mm"]["mean"].as_f64().unwrap();
                    assert!(mean < error_mm, "{name}: {mean} mm");
                    let traced = match &run["passage"] {
                        Value::Null => run["coverage"].as_f64(),
                        passage => passage["share"].as_f64(),
                    };
                    assert!(traced.unwrap() > coverage, "{name}: {traced:?}");
                }
            });
        }
    });
}

#[test]
fn the_policy_of_the_thesis_completes_all_scenes() {
    completes_all("thesis", 0.4, 0.95);
}

#[test]
fn the_default_policy_completes_all_scenes() {
    completes_all("vibrissa", 0.1, 0.9);
}

#[test]
fn the_policy_for_arrays_completes_all_scenes() {
    completes_all("array", 0.2, 0.95);
}
