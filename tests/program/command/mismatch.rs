//! The option `--mismatch` of commands.

use std::fs;
use std::path::Path;

use serde_json::Value;

use super::program::{ROOT, directory, stderr, stdout, vibrissa};

/// The result of a run of the disk in the quasi-static world.
fn run(arguments: &[&str]) -> Value {
    let disk = ["run", "scenarios/disk.yaml", "--policy", "policies/thesis.fsm", "--world", "quasistatic", "--json"];
    let output = vibrissa(&[&disk, arguments].concat());
    let mut results: Value = serde_json::from_str(&stdout(&output)).unwrap_or_else(|_| panic!("{}", stderr(&output)));
    results[0].take()
}

fn file(directory: &Path, name: &str, text: &str) -> String {
    let path = directory.join(name).display().to_string();
    fs::write(&path, text).unwrap();
    path
}

#[test]
fn a_mismatch_is_a_part_of_the_identity_of_a_run() {
    let directory = directory("mismatch_run");
    let soft = file(&directory, "soft.yaml", "stiffness: [-5 %, -1 %]\n");
    let (ideal, first, second) =
        (run(&[]), run(&["--mismatch", &soft]), run(&["--mismatch", &soft, "--mismatch-seed", "2"]));
    assert_eq!(ideal["mismatch"], Value::Null);
    assert_eq!(first["mismatch"], serde_json::json!({"file": soft, "seed": 0}));
    assert_eq!(second["mismatch"], serde_json::json!({"file": soft, "seed": 2}));
    let hashes = [&ideal, &first, &second].map(|result| result["hash"]["scenario"].as_str().unwrap());
    assert!(hashes[0] != hashes[1] && hashes[1] != hashes[2] && hashes[0] != hashes[2]);
    let bias = |result: &Value| result["tip_error_mm"]["bias"].as_f64().unwrap();
    assert!(bias(&first) > bias(&ideal) + 0.1 && (bias(&first) - bias(&second)).abs() > 1e-3);
}

#[test]
fn what_does_not_fit_is_refused_with_the_key() {
    let directory = directory("mismatch_refused");
    let other = file(&directory, "other.yaml", "whiskers: {r7: {length: 1 mm}}\n");
    let output = vibrissa(&["run", "scenarios/disk.yaml", "--mismatch", &other]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("the rig has no whisker `r7`"), "{}", stderr(&output));
    let wrong = file(&directory, "wrong.yaml", "name: disk\n");
    let output = vibrissa(&["run", "scenarios/disk.yaml", "--mismatch", &wrong]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("a mismatch has no key `name`"), "{}", stderr(&output));
}

/// The mismatch of every run of a sweep, in the order of runs.
fn mismatches(directory: &Path) -> Vec<Value> {
    let text = fs::read_to_string(directory.join("results.jsonl")).unwrap();
    let mut runs: Vec<Value> = text.lines().skip(1).map(|line| serde_json::from_str(line).unwrap()).collect();
    runs.sort_by_key(|run| run["key"].to_string());
    runs.into_iter().map(|mut run| run["mismatch"].take()).collect()
}

#[test]
fn a_sweep_passes_its_mismatch_to_its_workers_and_varies_single_keys() {
    let directory = directory("mismatch_sweep");
    let soft = file(&directory, "soft.yaml", "stiffness: [-5 %, -1 %]\n");
    let sweep = file(
        &directory,
        "small.yaml",
        &format!(
            "name: small\npolicies: [{ROOT}/policies/thesis.fsm]\nscenes: [{{scenario: {ROOT}/scenarios/disk.yaml, trials: 2}}]\n\
             vary: {{scenario: {{world: [quasistatic], stop: [{{time: 5 s}}], mismatch.seed: [10, 20]}}}}\n"
        ),
    );
    let out = directory.join("out").display().to_string();
    let sweep = |arguments: &[&str]| vibrissa(&[&["sweep", &sweep, "--out", &out], arguments].concat());
    let output = sweep(&["--mismatch", &soft]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let found = mismatches(Path::new(&out));
    // Every trial has its own array.
    let seeds: Vec<_> = found.iter().map(|mismatch| mismatch["seed"].as_u64().unwrap()).collect();
    assert!(found.iter().all(|mismatch| mismatch["file"] == soft.as_str()));
    assert_eq!(seeds, [10, 20, 11, 21]);
    let hard = file(&directory, "soft.yaml", "stiffness: [-50 %, -1 %]\n");
    let refused = sweep(&["--mismatch", &hard]);
    assert_eq!(refused.status.code(), Some(2));
    assert!(stderr(&refused).contains("another version of the mismatch"), "{}", stderr(&refused));
}

/// The results of the tests of `policy`, by their titles.
fn tests(policy: &str, arguments: &[&str]) -> Vec<Value> {
    let test = ["test", policy, "--world", "quasistatic", "--no-keep", "--cases", "2", "--json"];
    let output = vibrissa(&[&test, arguments].concat());
    serde_json::from_str(&stdout(&output)).unwrap_or_else(|_| panic!("{}", stderr(&output)))
}

#[test]
fn tests_and_properties_run_with_the_mismatch() {
    let directory = directory("mismatch_test");
    let text = fs::read_to_string(Path::new(ROOT).join("policies/thesis.fsm")).unwrap();
    let machine = text.split_once("\ntest ").map_or(text.as_str(), |(machine, _)| machine);
    let policy = file(
        &directory,
        "policy.fsm",
        &format!(
            "{machine}\ntest \"disk\" in \"{ROOT}/scenarios/disk.yaml\" {{ expect run.error_mean < 0.2 mm }}\n\
             property \"corners\" over convex-corner(angle = 90 deg, speed = 5 cm/s) {{ expect not (run.error_mean > 1 mm) }}\n"
        ),
    );
    let soft = file(&directory, "soft.yaml", "stiffness: [-9 %, -8 %]\n");
    let given = ["--mismatch", &soft, "--mismatch-seed", "4"];
    let (ideal, wrong) = (tests(&policy, &[]), tests(&policy, &given));
    let passed = |results: &[Value]| results.iter().map(|result| result["passed"] == true).collect::<Vec<_>>();
    assert_eq!(passed(&ideal), [true, true]);
    assert_eq!(passed(&wrong), [false, false]);
    for result in &wrong {
        assert_eq!(result["result"]["mismatch"], serde_json::json!({"file": soft, "seed": 4}));
    }
    // The command in the failing scenario has the same array.
    let scenario = wrong[1]["property"]["scenario"].as_str().unwrap();
    assert!(scenario.contains(&given.join(" ")), "{scenario}");
}
