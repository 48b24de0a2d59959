//! The project's policies do what the tests that they carry say.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::{fs, thread};

/// The policies and the test files, without libraries.
fn policies() -> Vec<PathBuf> {
    let folders = ["policies", "policies/tests"].map(|folder| Path::new(env!("CARGO_MANIFEST_DIR")).join(folder));
    let paths = folders.into_iter().flat_map(|folder| fs::read_dir(folder).unwrap()).map(|entry| entry.unwrap().path());
    paths.filter(|path| path.extension().is_some_and(|extension| extension == "fsm")).collect()
}

#[test]
fn every_policy_passes_the_tests_that_it_carries() {
    let tested = |policy: &Path| {
        let output = Command::new(env!("CARGO_BIN_EXE_vibrissa")).arg("test").arg(policy).output().unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stdout));
    };
    assert!(policies().len() >= 14);
    thread::scope(|scope| {
        for policy in policies() {
            scope.spawn(move || tested(&policy));
        }
    });
}

/// Ranges of corners, tunnels, walls and rooms. The quasi-static simulator runs each case in a fraction of the time of the other.
#[test]
fn the_default_policy_keeps_its_claims_over_whole_families() {
    let claims = Path::new(env!("CARGO_MANIFEST_DIR")).join("policies/tests/families/vibrissa.fsm");
    let arguments = ["--simulator", "quasistatic", "--cases", "5"];
    let output = Command::new(env!("CARGO_BIN_EXE_vibrissa")).arg("test").arg(claims).args(arguments).output().unwrap();
    let printed = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success() && printed.contains("11 tests, 0 failed"), "{printed}");
}
