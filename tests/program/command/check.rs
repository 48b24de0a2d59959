//! `vibrissa check`

use super::program::{bad, stderr, stdout, vibrissa};

#[test]
fn a_library_can_be_checked_and_not_compiled() {
    let corner = "tests/fixtures/policies/use/laws/corner.fsm";
    let output = vibrissa(&["check", corner]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert_eq!(stdout(&output), format!("{corner}: library corner, 1 law, 1 value\n"));
    let checked: serde_json::Value = serde_json::from_str(&stdout(&vibrissa(&["check", corner, "--json"]))).unwrap();
    let library = serde_json::json!({
        "name": "corner", "laws": ["wait"], "values": ["sharp"], "behaviours": [], "monitors": [],
    });
    assert_eq!(checked[0]["library"], library);
    let output = vibrissa(&["compile", corner, "-o", "/dev/null"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("is a library"), "{}", stderr(&output));
}

#[test]
fn a_fault_in_a_file_that_is_used_is_told_with_its_path() {
    let folder = "tests/fixtures/policies/use";
    let output = vibrissa(&["check", &format!("{folder}/fault_in_a_library.fsm"), "--json"]);
    assert_eq!(output.status.code(), Some(2));
    let checked: serde_json::Value = serde_json::from_str(&stdout(&output)).unwrap();
    assert_eq!(checked[0]["diagnostics"][0]["file"], format!("{folder}/laws/faulty.fsm"));
    let output = vibrissa(&["check", &format!("{folder}/file_that_is_not_there.fsm")]);
    assert!(stderr(&output).contains("did you mean `corner.fsm`?"), "{}", stderr(&output));
}

#[test]
fn check_says_what_a_policy_consists_of() {
    let output = vibrissa(&["check", "policies/thesis.fsm", "--json"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let checked: serde_json::Value = serde_json::from_str(&stdout(&output)).unwrap();
    assert_eq!(checked[0]["machine"]["name"], "thesis");
    assert_eq!(checked[0]["machine"]["states"][0]["name"], "Exploring");
    assert_eq!(checked[0]["diagnostics"], serde_json::json!([]));
    let output = vibrissa(&["check", "policies/thesis.fsm"]);
    assert!(stdout(&output).contains("Swiping"), "{}", stdout(&output));
}

#[test]
fn check_shows_a_state_in_a_state_below_it_and_farther_in_with_the_operations_of_both() {
    let policy = "tests/fixtures/charts/nested.fsm";
    let table = stdout(&vibrissa(&["check", policy]));
    let rows = ["Following ", "  Touching (initial) ", "    Swiping (initial) ", "    Pressing ", "  Searching "];
    let places: Vec<usize> = rows.iter().map(|row| table.find(&format!("\n {row}")).unwrap()).collect();
    assert!(places.is_sorted(), "{table}");
    let checked: serde_json::Value = serde_json::from_str(&stdout(&vibrissa(&["check", policy, "--json"]))).unwrap();
    let states = checked[0]["machine"]["states"].as_array().unwrap();
    let of = |name: &str| states.iter().find(|state| state["name"] == name).unwrap();
    assert_eq!((&of("Following")["parent"], &of("Swiping")["parent"]), (&serde_json::Value::Null, &"Touching".into()));
    let operations = |name: &str| of(name)["operations"].as_u64().unwrap();
    assert!(operations("Following") < operations("Touching") && operations("Touching") < operations("Swiping"));
}

#[test]
fn every_malformed_policy_is_refused_with_a_place_and_exit_status_2() {
    let files = bad("policies");
    assert!(files.len() >= 20);
    for file in files {
        let output = vibrissa(&["check", &file]);
        assert_eq!(output.status.code(), Some(2), "{file}");
        assert!(stderr(&output).contains(&format!("{file}:")), "{file}: {}", stderr(&output));
        assert_eq!(stdout(&output), "", "{file}");
    }
}

#[test]
fn warnings_are_shown_and_refused_on_demand() {
    let warned = "tests/fixtures/policies/warn/overlap_of_touches.fsm";
    let output = vibrissa(&["check", warned]);
    assert_eq!(output.status.code(), Some(0));
    assert!(stderr(&output).contains("warning[P0512]") && stderr(&output).contains(&format!("{warned}:10:8")));
    assert!(stdout(&output).contains("Exploring"), "what the policy consists of is told all the same");
    let output = vibrissa(&["check", warned, "--deny-warnings", "--json"]);
    assert_eq!((output.status.code(), stderr(&output).as_str()), (Some(2), ""));
    let checked: serde_json::Value = serde_json::from_str(&stdout(&output)).unwrap();
    assert_eq!(checked[0]["diagnostics"][0]["severity"], "warning");
    assert_eq!(checked[0]["machine"]["name"], "warned");
    assert_eq!(vibrissa(&["check", "policies/thesis.fsm", "--deny-warnings"]).status.code(), Some(0));
}

#[test]
fn a_file_that_cannot_be_read_keeps_no_other_from_being_checked() {
    let output = vibrissa(&["check", "--json", "policies/nothing.fsm", "policies/thesis.fsm"]);
    assert_eq!((output.status.code(), stderr(&output).as_str()), (Some(2), ""));
    let checked: serde_json::Value = serde_json::from_str(&stdout(&output)).unwrap();
    assert!(checked[0]["error"].as_str().unwrap().contains("cannot read policies/nothing.fsm"));
    assert_eq!((&checked[0]["machine"], &checked[1]["error"]), (&serde_json::Value::Null, &serde_json::Value::Null));
    assert_eq!(checked[1]["machine"]["name"], "thesis");
    let output = vibrissa(&["check", "policies/thesis.fsm", "policies/nothing.fsm"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stdout(&output).contains("Swiping") && stderr(&output).contains("cannot read policies/nothing.fsm"));
}
