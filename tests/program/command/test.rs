//! `vibrissa test`

#[cfg(feature = "sim")]
use std::path::Path;

#[cfg(feature = "sim")]
use super::program::{ROOT, stdout};
use super::program::{directory, stderr, vibrissa};
use crate::snapshots::snapshots;

#[test]
fn a_test_names_a_scenario_that_can_be_read() {
    let policy = directory("test-without-scenario").join("policy.fsm");
    let test = "test \"it runs\" in \"nowhere.yaml\" { expect run.completed }";
    std::fs::write(&policy, format!("machine m initial Still state Still {{ stop }} {test}")).unwrap();
    let output = vibrissa(&["test", policy.to_str().unwrap()]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("P0702") && stderr(&output).contains("nowhere.yaml"), "{}", stderr(&output));
}

#[test]
fn a_filter_that_no_title_passes_is_unusable() {
    let output = vibrissa(&["test", "policies/thesis.fsm", "--filter", "flies"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("`flies`"));
}

#[cfg(feature = "sim")]
#[test]
fn tests_pass_or_show_what_was_measured() {
    let policy = directory("tests").join("policy.fsm");
    let scenario = Path::new(ROOT).join("scenarios/disk.yaml");
    let scenario = scenario.display();
    let text = format!(
        "machine m param patience = 60 s in 1 .. 60 s
         initial Still state Still {{ stop after patience -> Late }} state Late {{ stop after 1 s -> Failure(\"late\") }}
         test \"it gives up\" in \"{scenario}\" {{
           set patience = 2 s
           expect run.failed and run.time_in(Late) > 0.9 s and run.time < patience + 1.2 s and run.visits(Late) == 1
         }}
         test \"it feels something\" in \"{scenario}\" {{ set patience = 1 s  expect run.error_mean < 1 mm or run.completed }}"
    );
    std::fs::write(&policy, text).unwrap();
    let output = vibrissa(&["test", policy.to_str().unwrap(), "--json"]);
    assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
    let tests: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!([&tests[0]["passed"], &tests[1]["passed"]], [true, false]);
    assert_eq!(tests[1]["diagnostics"][0]["secondary"][0]["label"], "is not known");
    assert_eq!(tests[1]["diagnostics"][0]["secondary"][1]["label"], "is false");

    let output = vibrissa(&["test", policy.to_str().unwrap(), "--filter", "gives up"]);
    assert_eq!((output.status.code(), stdout(&output).ends_with("1 test, 0 failed\n")), (Some(0), true));
    // That it fails is what it expects.
    assert_eq!(stderr(&output), "");
    let output = vibrissa(&["test", policy.to_str().unwrap(), "--filter", "feels something"]);
    let told = stderr(&output);
    assert!(told.contains("disk: failed: late") && told.contains("error[P0701]"), "{told}");
}

#[cfg(feature = "sim")]
#[test]
fn tests_read_the_figures_of_retrievals_as_the_result_has_them() {
    let policy = directory("test-retrievals").join("policy.fsm");
    let scenario = Path::new(ROOT).join("scenarios/prism.yaml").display().to_string();
    let text = std::fs::read_to_string(Path::new(ROOT).join("policies/thesis.fsm")).unwrap();
    std::fs::write(&policy, &text).unwrap();
    let output = vibrissa(&["run", &scenario, "--policy", policy.to_str().unwrap(), "--json"]);
    let run: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let retrieval = &run[0]["retrieval"];
    let [radius, distance] = ["radius_mm", "distance_mm"].map(|key| retrieval[key]["mean"].as_f64().unwrap());
    let bounds =
        |name: &str, mean: f64| format!("run.{name} > {:.6} mm and run.{name} < {:.6} mm", mean - 1e-3, mean + 1e-3);
    let test = format!(
        "test \"figures\" in \"{scenario}\" {{ expect run.retrievals == {} and {} and {} and not (run.axis_mean < 1 m) }}",
        retrieval["count"],
        bounds("retrieval_radius", radius),
        bounds("retrieval_distance", distance)
    );
    std::fs::write(&policy, text + &test).unwrap();
    let output = vibrissa(&["test", policy.to_str().unwrap(), "--filter", "figures"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
}

#[cfg(feature = "sim")]
#[test]
fn several_policies_are_tested_in_turn() {
    let output = vibrissa(&["test", "policies/thesis.fsm", "policies/bang.fsm", "--filter", "it comes round the disk"]);
    assert_eq!(output.status.code(), Some(0), "{}{}", stdout(&output), stderr(&output));
    assert!(stdout(&output).contains("policies/thesis.fsm: ") && stdout(&output).contains("policies/bang.fsm: "));
}

#[test]
fn a_scenario_that_cannot_be_read_is_shown_where_the_test_names_it() {
    let name = "scenario_that_is_not_there.fsm";
    let output = vibrissa(&["test", &format!("tests/fixtures/policies/test/{name}")]);
    assert_eq!((output.status.code(), output.stdout.len()), (Some(2), 0));
    snapshots("policies").bind(|| insta::assert_snapshot!(format!("test@{name}"), stderr(&output)));
}
