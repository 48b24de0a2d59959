//! The option `--mismatch` of commands.

use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};

use serde_json::Value;

use super::program::{ROOT, directory, stderr, stdout, vibrissa};

/// The result of a run of the disk in the quasi-static world.
fn run(arguments: &[&str]) -> Value {
    let disk =
        ["run", "scenarios/disk.yaml", "--policy", "policies/thesis.fsm", "--simulator", "quasistatic", "--json"];
    let output = vibrissa(&[&disk, arguments].concat());
    let mut results: Value = serde_json::from_str(&stdout(&output)).unwrap_or_else(|_| panic!("{}", stderr(&output)));
    results[0].take()
}

/// The same for an array that does not calibrate itself.
fn uncalibrated(arguments: &[&str]) -> Value {
    run(&[arguments, &["--uncalibrated"]].concat())
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
        (run(&[]), uncalibrated(&["--mismatch", &soft]), uncalibrated(&["--mismatch", &soft, "--mismatch-seed", "2"]));
    assert_eq!(ideal["mismatch"], Value::Null);
    assert_eq!(first["mismatch"], serde_json::json!({"file": soft, "seed": 0}));
    assert_eq!(second["mismatch"], serde_json::json!({"file": soft, "seed": 2}));
    let hashes = [&ideal, &first, &second].map(|result| result["hash"]["scenario"].as_str().unwrap());
    assert!(hashes[0] != hashes[1] && hashes[1] != hashes[2] && hashes[0] != hashes[2]);
    assert_eq!(ideal["calibration"], Value::Null);
    assert_eq!(first["calibration"], serde_json::json!({"kind": "uncalibrated", "hash": null, "cached": false}));
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
    let sweep =
        |arguments: &[&str]| vibrissa(&[&["sweep", &sweep, "--uncalibrated", "--out", &out], arguments].concat());
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
    let test = ["test", policy, "--simulator", "quasistatic", "--no-keep", "--cases", "2", "--json"];
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
    let given = ["--mismatch", &soft, "--mismatch-seed", "4", "--uncalibrated"];
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

/// A policy that swipes for some seconds, so that all scenes are fast.
fn short_policy(directory: &Path) -> String {
    let text = fs::read_to_string(Path::new(ROOT).join("policies/thesis.fsm")).unwrap();
    let machine = text.split_once("\ntest ").map_or(text.as_str(), |(machine, _)| machine);
    file(directory, "thesis.fsm", machine)
}

const PLAUSIBLE: &str = "scenarios/mismatch/plausible.yaml";

#[test]
fn an_array_has_the_same_calibration_and_figures_in_every_command() {
    let directory = directory("mismatch_commands");
    let policy = short_policy(&directory);
    let common = ["--policy", &policy, "--simulator", "quasistatic", "--mismatch", PLAUSIBLE, "--json"];
    let results = |command: &[&str]| -> Vec<Value> {
        let output = vibrissa(&[command, &common].concat());
        assert!(stderr(&output).contains("calibrat"), "{}", stderr(&output));
        serde_json::from_str(&stdout(&output)).unwrap_or_else(|_| panic!("{}", stderr(&output)))
    };
    let (bench, run) = (results(&["bench"]), results(&["run", "scenarios/box.yaml"]));
    let of_box = bench.iter().find(|row| row["scenario"] == "box").unwrap();
    for key in ["error_mm", "tip_error_mm", "coverage", "sim_s", "path_m", "mismatch", "hash"] {
        assert_eq!(run[0][key], of_box[key], "{key}");
    }
    let calibration = |result: &Value| (result["calibration"]["kind"].clone(), result["calibration"]["hash"].clone());
    assert_eq!(calibration(&run[0]), calibration(of_box));
    assert_eq!(run[0]["calibration"]["kind"], "touches");

    // A section of the scenario means the same as the option.
    let text = fs::read_to_string(Path::new(ROOT).join("scenarios/box.yaml"))
        .unwrap()
        .replace("policies", &format!("{ROOT}/policies"));
    let text = text.replace("../", "");
    let mismatch = format!("mismatch: {{from: {ROOT}/{PLAUSIBLE}}}\n");
    let section = file(&directory, "box.yaml", &(text + &mismatch));
    let output = vibrissa(&["run", &section, "--policy", &policy, "--simulator", "quasistatic", "--json"]);
    let found: Value = serde_json::from_str(&stdout(&output)).unwrap_or_else(|_| panic!("{}", stderr(&output)));
    assert_eq!((&found[0]["error_mm"], calibration(&found[0])), (&run[0]["error_mm"], calibration(&run[0])));

    // So does a trial of a sweep, in a process of its own.
    let sweep = format!(
        "name: one\npolicies: [{policy}]\nscenes: [{{scenario: {ROOT}/scenarios/box.yaml}}]\nvary: {{scenario: {{world: [quasistatic]}}}}\n"
    );
    let (sweep, out) = (file(&directory, "one.yaml", &sweep), directory.join("out"));
    let output = vibrissa(&["sweep", &sweep, "--mismatch", PLAUSIBLE, "--out", &out.display().to_string()]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert!(stderr(&output).contains("calibrated by its own touches"), "{}", stderr(&output));
    let lines = fs::read_to_string(out.join("results.jsonl")).unwrap();
    let line: Value = serde_json::from_str(lines.lines().nth(1).unwrap()).unwrap();
    assert_eq!((&line["error_mm"], calibration(&line)), (&run[0]["error_mm"], calibration(&run[0])));
}

/// The program with a cache of its own.
fn with_cache(cache: &Path, scenario: &str) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_vibrissa"));
    let arguments = [
        "run",
        scenario,
        "--policy",
        "policies/thesis.fsm",
        "--simulator",
        "quasistatic",
        "--mismatch",
        PLAUSIBLE,
        "--json",
    ];
    command
        .args(arguments)
        .env("VIBRISSA_CACHE", cache)
        .current_dir(ROOT)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped());
    command
}

#[test]
fn a_calibration_is_kept_and_a_damaged_one_is_made_again() {
    let directory = directory("mismatch_cache");
    let text = "name: short\nobjects: [{circle: {centre: [0.4 m, 0.4 m], radius: 0.3 m}}]\nstart: {position: [0 m, 72 mm], heading: 90 deg}\nstop: {time: 8 s}\n";
    let (scenario, cache) = (file(&directory, "short.yaml", text), directory.join("cache"));
    let read = |output: std::process::Output| -> (Value, bool) {
        let mut results: Value =
            serde_json::from_str(&stdout(&output)).unwrap_or_else(|_| panic!("{}", stderr(&output)));
        let cached = results[0]["calibration"]["cached"].as_bool().unwrap();
        (results[0]["error_mm"].take(), cached)
    };
    let run = || read(with_cache(&cache, &scenario).output().unwrap());
    // Two processes at once.
    let both = [(); 2].map(|()| with_cache(&cache, &scenario).spawn().unwrap());
    let [first, second] = both.map(|child| read(child.wait_with_output().unwrap()));
    assert_eq!(first.0, second.0);
    assert_eq!(run(), (first.0.clone(), true));
    let kept: Vec<_> = fs::read_dir(cache.join("calibrations")).unwrap().map(|entry| entry.unwrap().path()).collect();
    let [kept] = kept.as_slice() else { panic!("{kept:?}") };
    let whole = fs::read(kept).unwrap();
    let mut flipped = whole.clone();
    let digit = flipped.iter().rposition(u8::is_ascii_digit).unwrap();
    flipped[digit] = if flipped[digit] == b'1' { b'2' } else { b'1' };
    for damaged in [&whole[..whole.len() / 2], &flipped, b""] {
        fs::write(kept, damaged).unwrap();
        assert_eq!(run(), (first.0.clone(), false));
        assert_eq!(fs::read(kept).unwrap(), whole);
    }
    // Without a place for a cache, an array is calibrated all the same.
    fs::write(directory.join("file"), "").unwrap();
    for none in [directory.join("file"), "".into()] {
        assert_eq!(read(with_cache(&none, &scenario).output().unwrap()), (first.0.clone(), false));
    }
}

#[test]
fn a_seed_without_effect_is_an_error() {
    let directory = directory("mismatch_seeds");
    let fixed = file(&directory, "fixed.yaml", "stiffness: 5 %\n");
    let noisy = file(&directory, "noisy.yaml", "sensor: {noise: 0.1 urad}\n");
    let (run, bench) = (&["run", "scenarios/disk.yaml"][..], &["bench", "--ideal"][..]);
    let refused = |command: &[&str], options: &[&str], of: &str| {
        let output = vibrissa(&[command, options].concat());
        assert_eq!(output.status.code(), Some(2), "{command:?} {options:?}");
        assert!(stderr(&output).contains(&format!("the seed of {of} has no effect")), "{}", stderr(&output));
    };
    let compare = ["compare", "policies/bang.fsm", "policies/thesis.fsm"];
    let test = ["test", "policies/thesis.fsm"];
    for command in [
        run,
        bench,
        &compare,
        &test,
        &["families", "--count", "1"],
        &["study", "estimators"],
        &["study", "pareto"],
        &["inspect", "diff", "policies/bang.fsm", "policies/thesis.fsm"],
        &["calibrate", "--self"],
    ] {
        refused(command, &["--mismatch-seed", "3", "--mismatch", &fixed], "the mismatch");
    }
    refused(run, &["--mismatch-seed", "3"], "the mismatch");
    for command in [run, bench] {
        refused(command, &["--seed", "3"], "the noise");
        refused(command, &["--seed", "3", "--mismatch", &fixed], "the noise");
    }
    refused(&["calibrate"], &["--seed", "3"], "the noise");
    refused(&["calibrate", "--self"], &["--seed", "3", "--mismatch", &fixed], "the noise");
    let seeded =
        |seed: &str| self::run(&["--mismatch", &noisy, "--uncalibrated", "--seed", seed])["error_mm"]["mean"].clone();
    assert_ne!(seeded("3"), seeded("4"));
}

/// A policy with an optional whisker failed in the whole bench from a friction of 0.4 on.
#[test]
fn friction_ends_the_curve_of_a_whisker_and_refuses_no_run() {
    let directory = directory("friction");
    for friction in ["0.4", "1", "3"] {
        let text = format!(
            "name: rough\nworld: quasistatic\nrig: {{physics: {{friction: {friction}}}, sensing: {{friction: {friction}}}}}\n\
             objects: [{{circle: {{centre: [0.4 m, 0.4 m], radius: 0.3 m}}}}]\nstart: {{position: [0 m, 72 mm], heading: 90 deg}}\nstop: {{time: 3 s}}\n"
        );
        let rough = file(&directory, "rough.yaml", &text);
        for policy in ["policies/thesis.fsm", "policies/vibrissa.fsm"] {
            let output = vibrissa(&["run", &rough, "--policy", policy]);
            assert!(matches!(output.status.code(), Some(0 | 1)), "{friction}, {policy}: {}", stderr(&output));
        }
    }
}

/// A rat's whisker: 30 mm long, 0.1 mm thick at the base and 4 um at the tip. Its last links have less inertia than MuJoCo takes, and
/// what is added to them is far below the inertia of the whisker.
#[test]
fn whiskers_of_a_rat_run_in_both_simulators_and_lighter_ones_are_refused_by_the_one_with_inertia() {
    let directory = directory("rat");
    let of_rat = "{length: 30 mm, radius: 0.05 mm, tip_radius: 0.002 mm, young_modulus: 3 GPa, density: 1300 kg/m^3}";
    let scene = |world: &str, whisker: &str| {
        format!(
            "name: rat\n{world}rig:\n  whiskers:\n    r0: {whisker}\n    l0: {whisker}\nobjects: [{{circle: {{centre: [0.4 m, 0.4 m], radius: 0.3 m}}}}]\n\
             start: {{position: [0 m, 72 mm], heading: 90 deg}}\nstop: {{time: 20 s}}\n"
        )
    };
    let rat = file(&directory, "rat.yaml", &scene("world: quasistatic\n", of_rat));
    let worlds = if cfg!(feature = "sim") { &["quasistatic", "mujoco"][..] } else { &["quasistatic"] };
    for world in worlds {
        let output = vibrissa(&["run", &rat, "--json", "--simulator", world]);
        let results: Value = serde_json::from_str(&stdout(&output)).unwrap_or_else(|_| panic!("{}", stderr(&output)));
        assert!(results[0]["sim_s"].as_f64().unwrap() > 1.0, "{world}: {results}");
    }
    let wire = "{radius: 2 um, links: 64, density: 500 kg/m^3}";
    // The command chooses the simulator where the scenario does not.
    let light = file(&directory, "light.yaml", &scene("", wire));
    let output = vibrissa(&["run", &light, "--json", "--simulator", "quasistatic"]);
    assert!(!stdout(&output).is_empty(), "{}", stderr(&output));
    if cfg!(feature = "sim") {
        let output = vibrissa(&["run", &light, "--simulator", "mujoco"]);
        assert_eq!(output.status.code(), Some(2));
        let told = stderr(&output);
        assert!(
            told.contains("whisker `r0` are too light to be simulated by MuJoCo") && told.contains("quasistatic"),
            "{told}"
        );
    }
    let output = vibrissa(&["run", &file(&directory, "mujoco.yaml", &scene("world: mujoco\n", wire))]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("or write `world: quasistatic`"), "{}", stderr(&output));
}

#[test]
fn a_third_of_the_readings_lost_gives_no_command_that_is_not_finite() {
    let directory = directory("mismatch_lost");
    // With two samples in a tick, every tenth tick of a whisker has no reading.
    let scene = file(
        &directory,
        "scene.yaml",
        "name: scene\nrig: {sensing: {sample_rate: 150 Hz, control_rate: 75 Hz}}\n\
         objects: [{circle: {centre: [40 cm, 40 cm], radius: 30 cm}}]\n\
         start: {position: [0 mm, 72 mm], heading: 90 deg}\nstop: {time: 20 s}\n",
    );
    for kind in ["nan", "missing"] {
        let lost =
            file(&directory, &format!("{kind}.yaml"), &format!("sensor:\n  lost: {{share: 30 %, kind: {kind}}}\n"));
        let arguments = ["run", &scene, "--policy", "policies/vibrissa.fsm", "--simulator", "quasistatic", "--json"];
        let output = vibrissa(&[&arguments[..], &["--mismatch", &lost, "--uncalibrated"]].concat());
        let results: Value = serde_json::from_str(&stdout(&output)).unwrap_or_else(|_| panic!("{}", stderr(&output)));
        assert_eq!(results[0]["failsafes"]["count"], 0, "{kind}: {}", results[0]);
        assert_ne!(results[0]["outcome"], "failed", "{kind}: {}", stderr(&output));
    }
}

#[test]
fn an_array_that_is_not_calibrated_needs_a_mismatch() {
    for command in [
        &["run", "disk"][..],
        &["compare", "thesis", "vibrissa", "disk"],
        &["bench", "--ideal"],
        &["families", "convex-corner", "--count", "1"],
    ] {
        let output = vibrissa(&[command, &["--uncalibrated", "--simulator", "quasistatic"]].concat());
        assert_eq!(output.status.code(), Some(2), "{command:?}");
        assert!(stderr(&output).contains("--uncalibrated has no effect"), "{command:?}: {}", stderr(&output));
    }
}

/// Pages are stamped by figures of ideal arrays. A change of the calibration changes none of them.
#[cfg(feature = "sim")]
#[test]
fn pages_have_the_figures_that_their_commands_print() {
    let error = |arguments: &[&str]| {
        let output = vibrissa(&[&["run", "scenarios/box.yaml", "--json"], arguments].concat());
        let results: Value = serde_json::from_str(&stdout(&output)).unwrap();
        format!("{:.3}", results[0]["error_mm"]["mean"].as_f64().unwrap())
    };
    let cell = |page: &str, section: &str, column: usize| {
        let text = fs::read_to_string(Path::new(ROOT).join(page)).unwrap();
        let below = text.split_once(section).unwrap().1;
        below
            .lines()
            .find(|line| line.starts_with("| box |"))
            .unwrap()
            .split('|')
            .nth(column)
            .unwrap()
            .trim()
            .to_owned()
    };
    for (name, column) in [("thesis", 6), ("vibrissa", 7)] {
        let policy = format!("policies/{name}.fsm");
        let ideal = cell("README.md", "## Results", column);
        assert_eq!(error(&["--policy", &policy]), ideal, "{policy}: run `cargo x results bench`");
        let array = ["--policy", &policy, "--mismatch", "scenarios/mismatch/plausible.yaml"];
        let plausible =
            cell("docs/results/mismatch.md", &format!("## Arrays under `{policy}`").replace("policies/", ""), 3);
        // An outcome other than `completed` stands behind the error.
        assert_eq!(
            Some(error(&array).as_str()),
            plausible.split(',').next(),
            "{policy}: run `cargo x results mismatch calibration pareto`"
        );
    }
}
