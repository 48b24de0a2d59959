//! Contracts of a policy, as `check`, `run` and `test` report them.

use std::path::Path;

use serde_json::Value;

use super::program::{ROOT, directory, stderr, stdout, vibrissa};

/// A policy with three contracts. One is proved, one is kept, and one is violated from 2 s to 3 s.
const POLICY: &str = "machine waiting
whisker r0
param patience = 3 s in 1 s .. 10 s
initial Still
never patience > 20 s
state Still {
  never time > 2 s
  always |r0.base_angle| < 100 urad within 1 s
  stop
  after patience -> Success(\"waited\")
}";

fn policy(folder: &str, rest: &str) -> String {
    let file = directory(folder).join("waiting.fsm");
    std::fs::write(&file, format!("{POLICY}\n{rest}")).unwrap();
    file.display().to_string()
}

#[test]
fn check_says_which_contracts_are_proved() {
    let output = vibrissa(&["check", &policy("contracts-check", ""), "--json"]);
    let checked: Value = serde_json::from_str(&stdout(&output)).unwrap();
    let contracts = checked[0]["machine"]["contracts"].as_array().unwrap();
    let proved: Vec<_> = contracts.iter().map(|one| (one["contract"].as_str().unwrap(), &one["proved"])).collect();
    assert_eq!(
        proved,
        [
            ("never patience > 20 s", &Value::Bool(true)),
            ("never time > 2 s", &Value::Bool(false)),
            ("always |r0.base_angle| < 100 urad within 1 s", &Value::Bool(false)),
        ]
    );
}

#[test]
fn a_run_that_violates_a_contract_does_not_pass_and_shows_where() {
    let folder = directory("contracts-run");
    let lines = folder.join("transitions.jsonl").display().to_string();
    let policy = policy("contracts-run-policy", "");
    let run = ["run", "scenarios/disk.yaml", "--simulator", "quasistatic", "--policy", &policy];
    let output = vibrissa(&[&run[..], &["--json", "--transitions", &lines]].concat());
    assert_eq!(output.status.code(), Some(1));
    let told = stderr(&output);
    assert!(told.contains("state Still: violated `never time > 2 s` in 30 ticks, first at 2.03 s"), "{told}");
    assert!(told.contains("the policy violated one of its contracts"), "{told}");
    let results: Value = serde_json::from_str(&stdout(&output)).unwrap();
    let [violated, kept] = &results[0]["contracts"].as_array().unwrap()[..] else { panic!("{results}") };
    assert_eq!((&violated["violations"], &kept["violations"]), (&30.into(), &0.into()));
    let margin = |contract: &Value| contract["smallest_margin"]["margin_si"].as_f64().unwrap();
    assert!((margin(violated) + 1.0).abs() < 0.05 && margin(kept) > 9e-5, "{results}");
    let lines = std::fs::read_to_string(lines).unwrap();
    let lines: Vec<Value> = lines.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    let violations: Vec<_> = lines.iter().filter(|line| line["format"] == "violation").collect();
    let [violation] = violations[..] else { panic!("{lines:?}") };
    assert_eq!((&violation["state"], &violation["line"]), (&"Still".into(), &7.into()));
    assert_eq!(violation["parts"][0]["text"], "time > 2 s");
}

#[test]
fn a_test_fails_if_its_run_violates_a_contract() {
    let scenario = Path::new(ROOT).join("scenarios/disk.yaml");
    let block = |title: &str, patience: &str| {
        format!(
            "test \"{title}\" in \"{}\" {{ set patience = {patience}  expect run.completed }}\n",
            scenario.display()
        )
    };
    let policy = policy("contracts-test", &(block("short", "1 s") + &block("long", "4 s")));
    let output = vibrissa(&["test", &policy, "--json"]);
    assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
    let tests: Value = serde_json::from_str(&stdout(&output)).unwrap();
    assert_eq!([&tests[0]["passed"], &tests[1]["passed"]], [true, false], "{tests}");
    assert_eq!(tests[1]["diagnostics"][0]["code"], "P0705");
}
