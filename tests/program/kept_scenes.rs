//! Scenes that the default policy fulfils without a change of its gains: other rigs, and drawn scenes in which it once failed.

use std::path::Path;
use std::process::Command;

use serde_json::Value;

fn fulfils_all(scenes: &[&str], world: &str) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenarios/more");
    let files = scenes.iter().map(|scene| folder.join(format!("{scene}.yaml")));
    let mut command = Command::new(env!("CARGO_BIN_EXE_vibrissa"));
    let output = command.arg("run").args(files).args(["--simulator", world, "--json"]).output().unwrap();
    let runs: Vec<Value> = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(runs.len(), scenes.len());
    // The expectations of the scenes bound errors, coverage and collisions.
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
}

#[test]
fn other_rigs_fulfil_their_expectations_without_inertia() {
    fulfils_all(&["wide-body-box", "long-whisker-box", "short-whisker-disk"], "quasistatic");
}

#[cfg(feature = "sim")]
#[test]
fn other_rigs_fulfil_their_expectations_with_inertia() {
    fulfils_all(&["wide-body-box", "long-whisker-box", "short-whisker-disk"], "mujoco");
}

#[test]
fn no_tip_is_recorded_beside_a_wall_or_past_an_edge() {
    fulfils_all(&["shaft-at-mouth", "askew-mouth", "slip-at-speed"], "quasistatic");
}
