//! What commands write as JSON, against the schemas of the documentation.

use std::fs;

use jsonschema::Validator;
use serde_json::Value;

use super::program::{ROOT, directory, stderr, stdout, vibrissa};

fn validator(format: &str) -> Validator {
    let schema = fs::read_to_string(format!("{ROOT}/docs/schema/{format}.schema.json")).unwrap();
    jsonschema::validator_for(&serde_json::from_str(&schema).unwrap()).unwrap()
}

/// Checks that a document is as its schema says.
fn check_itself(format: &str, document: &Value) {
    let validator = validator(format);
    let faults: Vec<_> =
        validator.iter_errors(document).map(|fault| format!("{}: {fault}", fault.instance_path())).collect();
    assert!(faults.is_empty(), "{format}: {faults:?}");
}

/// Checks that a document is as its schema says, and that it is not without any one of its keys.
pub(crate) fn check(format: &str, document: &Value) {
    check_itself(format, document);
    let validator = validator(format);
    for key in document.as_object().unwrap().keys() {
        let mut without = document.clone();
        without.as_object_mut().unwrap().remove(key);
        assert!(!validator.is_valid(&without), "{format} is valid without {key}");
    }
}

fn printed(arguments: &[&str]) -> Value {
    let output = vibrissa(arguments);
    serde_json::from_str(&stdout(&output)).unwrap_or_else(|fault| panic!("{arguments:?}: {fault}: {}", stderr(&output)))
}

#[test]
fn what_commands_write_is_as_the_schemas_say() {
    let directory = directory("schema");
    let path = |name: &str| directory.join(name).display().to_string();
    let world = ["--simulator", "quasistatic"];
    let ticks = path("ticks.jsonl");
    let disk = fs::read_to_string("scenarios/disk.yaml").unwrap().replace("../policies", &format!("{ROOT}/policies"));
    let scenario = path("disk.yaml");
    fs::write(&scenario, disk.replace("time: 120 s", "time: 9 s")).unwrap();
    check("run", &printed(&[&["run", &scenario, "--json", "--ticks", &ticks][..], &world].concat())[0]);
    let ticks = fs::read_to_string(ticks).unwrap();
    check("tick", &serde_json::from_str(ticks.lines().last().unwrap()).unwrap());
    check("pruning", &printed(&[&["inspect", "explain", &scenario, "--json"][..], &world].concat()));
    for policy in ["policies/bang.fsm", "tests/fixtures/policies/bad/unclosed.fsm"] {
        check("check", &printed(&["check", policy, "--json"])[0]);
    }
    check("family-run", &printed(&[&["families", "convex-corner", "--count", "1", "--json"][..], &world].concat())[0]);
    check(
        "comparison",
        &printed(
            &[
                &["compare", "policies/bang.fsm", "policies/reverse.fsm", &scenario, "--seeds", "2", "--json"][..],
                &world,
            ]
            .concat(),
        ),
    );

    let sweep = path("sweep.yaml");
    let text = format!(
        "name: small\nvary: {{scenario: {{world: [quasistatic]}}}}\npolicies: [{ROOT}/policies/bang.fsm]\nscenes: [{{scenario: {scenario}, trials: 2}}]\n"
    );
    fs::write(&sweep, text).unwrap();
    let out = path("out");
    check("sweep-summary", &printed(&["sweep", &sweep, "--out", &out, "--json"]));
    let results = fs::read_to_string(directory.join("out/results.jsonl")).unwrap();
    let lines: Vec<Value> = results.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    check("sweep", &lines[0]);
    // A run without a result has fewer keys.
    check_itself("sweep-run", &lines[1]);

    // Results of before there were versions.
    let old = results.replace(r#""format":"sweep","version":1,"#, "");
    assert_ne!(old, results);
    fs::write(directory.join("out/results.jsonl"), old).unwrap();
    let output = vibrissa(&["sweep", &sweep, "--out", &out]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("no version of the format"), "{}", stderr(&output));
}
