//! `vibrissa tune`.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use serde_json::Value;

use super::program::{ROOT, directory, stderr, stdout, vibrissa, without_origin};

/// A few runs of a detuned policy in the quasi-static world.
fn tune(out: &Path, more: &[&str]) -> std::process::Output {
    let [policy, disk, octagon] =
        ["policies/thesis.fsm", "scenarios/disk.yaml", "scenarios/octagon.yaml"].map(|path| format!("{ROOT}/{path}"));
    let out = out.display().to_string();
    let mut arguments = vec!["tune", &policy, "--simulator", "quasistatic", "--param", "target", "--param", "light"];
    arguments.extend(["--set", "target=700 urad", "--scene", &disk, "--held-out", &octagon, "--runs", "14"]);
    arguments.extend(["--json", "--out", &out]);
    arguments.extend(more);
    vibrissa(&arguments)
}

fn document(output: &std::process::Output) -> Value {
    let mut document: Value = serde_json::from_str(&stdout(output)).unwrap_or_else(|_| panic!("{}", stderr(output)));
    assert!(document["provenance"].take().is_object());
    document
}

fn lines(directory: &Path) -> BTreeSet<String> {
    without_origin(&fs::read_to_string(directory.join("results.jsonl")).unwrap()).lines().map(str::to_owned).collect()
}

/// The values of the policy itself, the given ones and the tuned ones.
fn costs(tuning: &Value, scenes: &str) -> [f64; 3] {
    let values = tuning["values"].as_array().unwrap();
    assert_eq!(
        values.iter().map(|values| values["of"].as_str().unwrap()).collect::<Vec<_>>(),
        ["policy", "given", "tuned"]
    );
    [0, 1, 2].map(|index| values[index][scenes]["cost"].as_f64().unwrap())
}

#[test]
fn a_detuned_policy_is_improved_and_an_interrupted_tuning_gives_the_same_result() {
    let folder = directory("tune");
    let [whole, torn] = ["whole", "torn"].map(|name| folder.join(name));
    let written = folder.join("tuned.fsm");
    let output = tune(&whole, &["--write", &written.display().to_string()]);
    let tuning = document(&output);
    let [shipped, given, tuned] = costs(&tuning, "training");
    assert!(tuned < given, "{tuning}");
    assert!(tuned < 1.1 * shipped, "{tuning}");
    let [shipped, given, tuned] = costs(&tuning, "held_out");
    assert!(tuned < given && tuned < 1.1 * shipped, "{tuning}");

    // The written policy has the tuned values, and they are within the declared ranges.
    let text = fs::read_to_string(&written).unwrap();
    for parameter in tuning["parameters"].as_array().unwrap() {
        let [name, value] = ["name", "tuned"].map(|key| parameter[key].as_str().unwrap());
        let line = text.lines().find(|line| line.starts_with(&format!("param {name} "))).unwrap();
        assert!(line.contains(&format!("= {value} ")), "{line}");
    }
    assert_eq!(vibrissa(&["check", &written.display().to_string()]).status.code(), Some(0));

    // The beginning of the results, as a kill in the middle of writing leaves it.
    let text = fs::read_to_string(whole.join("results.jsonl")).unwrap();
    let begun: Vec<&str> = text.lines().take(6).collect();
    fs::create_dir_all(&torn).unwrap();
    fs::write(torn.join("results.jsonl"), begun.join("\n") + "\n{\"format\":\"tuning-run\",\"ver").unwrap();
    let mut resumed = document(&tune(&torn, &["--jobs", "2"]));
    assert_eq!(resumed["resumed"], 5);
    resumed["resumed"] = tuning["resumed"].clone();
    assert_eq!(resumed, tuning);
    assert_eq!(lines(&torn), lines(&whole));

    for (change, told) in [(["--seed", "2"], "the seed"), (["--weight", "time=1"], "the objective")] {
        let output = tune(&whole, &change);
        assert_eq!(output.status.code(), Some(2));
        assert!(stderr(&output).contains(&format!("another version of {told}")), "{}", stderr(&output));
    }
}

#[test]
fn what_cannot_be_tuned_is_refused_before_the_first_run() {
    let folder = directory("tune-refused");
    for (arguments, told) in [
        (&["--param", "none"][..], "the policy has no parameter `none`"),
        (&["--param", "light"], "named twice"),
        (&["--scene", "no-family"], "there is no family `no-family`"),
        (&["--scene", "scenarios/octagon.yaml"], "is also a training scene"),
        (&["--scene", "scenarios/disk.yaml"], "occurs twice"),
        (&["--weight", "speed=1"], "error_mean"),
        (&["--weight", "time=-1"], "0 or more"),
        (&["--scene", "polygon", "--count", "50"], "too few runs"),
        (&["--write", "policies/thesis.fsm"], "this command reads it as"),
    ] {
        let output = tune(&folder, arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert!(stderr(&output).contains(told), "{arguments:?}: {}", stderr(&output));
        assert!(!folder.join("results.jsonl").exists() || lines(&folder).len() <= 1, "{arguments:?}");
    }
}
