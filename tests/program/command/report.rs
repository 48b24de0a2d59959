//! The pages that commands write.

use std::fs;
use std::path::Path;

use serde_json::Value;

use super::program::{directory, stderr, stdout, vibrissa};

/// The text between two texts.
fn between<'t>(text: &'t str, before: &str, after: &str) -> &'t str {
    let rest = text.split_once(before).unwrap_or_else(|| panic!("no `{before}`")).1;
    rest.split_once(after).unwrap_or_else(|| panic!("no `{after}`")).0
}

/// A policy that moves ahead for three seconds and fails, in a scene of its own.
fn failing(directory: &Path) -> String {
    let policy = "machine blind\nwhisker r0\ninitial Ahead\nstate Ahead {\n  steer body along direction(body.yaw) at 50 mm/s turning 0 deg/s\n  \
                  after 3 s -> Failure(\"no <surface>\")\n}\n";
    fs::write(directory.join("blind.fsm"), policy).unwrap();
    let scene = "name: far\nobjects: [{circle: {centre: [3 m, 3 m], radius: 100 mm}}]\nstart: {position: [0 m, 0 m], heading: 0 deg}\n\
                 stop: {time: 9 s}\npolicy: blind.fsm\nworld: quasistatic\n";
    let path = directory.join("far.yaml");
    fs::write(&path, scene).unwrap();
    path.display().to_string()
}

#[test]
fn the_page_of_runs_begins_with_the_run_that_failed_and_its_reason() {
    let directory = directory("report-run");
    let out = directory.display().to_string();
    let box_scene = "scenarios/box.yaml";
    let output = vibrissa(&["run", box_scene, &failing(&directory), "--simulator", "quasistatic", "--out", &out]);
    assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
    assert!(stdout(&output).contains("index.html"));
    let page = fs::read_to_string(directory.join("index.html")).unwrap();
    let failed = between(&page, "<h2>Not passed</h2>", "</section>");
    assert!(
        failed.contains("far") && failed.contains("failed: no &lt;surface&gt;") && !failed.contains(">box<"),
        "{failed}"
    );
    // The largest error of the page is that of the result, with a state of the policy.
    let result: Value = serde_json::from_str(&fs::read_to_string(directory.join("box.json")).unwrap()).unwrap();
    let worst = between(&page, "<h2>Largest errors</h2>", "</section>");
    let shown: f64 = between(worst, "<b>", " mm</b>").rsplit('>').next().unwrap().parse().unwrap();
    let max = result["error_mm"]["max"].as_f64().unwrap();
    assert!((shown - max).abs() <= 0.005 * max.max(0.1), "{shown} is not {max}");
    let state = between(worst, "in the state <b>", "</b>");
    assert!(result["states"].as_object().unwrap().contains_key(state), "{state}");
    // Nothing is loaded from elsewhere.
    for source in ["src=\"", "url(http", "@import", "<link"] {
        assert!(!page.contains(source), "{source}");
    }
}

#[test]
fn a_comparison_is_written_as_sentences_with_the_verdicts_of_its_document() {
    let directory = directory("report-compare");
    let out = directory.display().to_string();
    let files = ["policies/bang.fsm", "policies/thesis.fsm", "scenarios/disk.yaml", "scenarios/rounded-rectangle.yaml"];
    let output = vibrissa(&[&["compare", "--simulator", "quasistatic", "--out", &out], &files[..]].concat());
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let document: Value =
        serde_json::from_str(&fs::read_to_string(directory.join("comparison.json")).unwrap()).unwrap();
    let page = fs::read_to_string(directory.join("index.html")).unwrap();
    let sentences = between(&page, "<ul class=\"changes\">", "</ul>");
    let figures = document["figures"].as_array().unwrap();
    assert!(!figures.is_empty());
    for figure in figures {
        let name = figure["figure"].as_str().unwrap();
        // A share is shown in %.
        let name = format!("<code>{}</code>", if name == "completed" { "completed %" } else { name });
        assert_eq!(sentences.contains(&name), figure["outlook"] != "same", "{name}");
    }
    let results: Value = serde_json::from_str(&fs::read_to_string(directory.join("results.json")).unwrap()).unwrap();
    assert_eq!(results.as_array().unwrap().len(), 4);
}

#[test]
fn the_page_of_a_comparison_lists_the_runs_that_did_not_complete() {
    let directory = directory("report-incomplete");
    let (scene, out) = (failing(&directory), directory.display().to_string());
    let blind = directory.join("blind.fsm").display().to_string();
    let output = vibrissa(&["compare", "policies/bang.fsm", &blind, &scene, "--out", &out]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let document: Value =
        serde_json::from_str(&fs::read_to_string(directory.join("comparison.json")).unwrap()).unwrap();
    let page = fs::read_to_string(directory.join("index.html")).unwrap();
    let listed = between(&page, "<h2>Runs that did not complete</h2>", "</section>");
    let run = &document["policies"][1]["incomplete"][0];
    assert_eq!(run["outcome"], "failed");
    for text in ["blind.fsm", "far", ">0<", "failed", "no &lt;surface&gt;"] {
        assert!(listed.contains(text), "{text}: {listed}");
    }
    // The share of completed runs has one form.
    assert!(page.contains("completed %") && !page.contains("<code>completed</code>"));
}

#[test]
fn a_sweep_draws_the_runs_that_did_not_pass_and_its_page_opens_them() {
    let directory = directory("report-sweep");
    failing(&directory);
    let disk = fs::canonicalize("scenarios/disk.yaml").unwrap().display().to_string();
    let text = format!(
        "name: two\npolicies: [blind.fsm]\nscenes: [{{scenario: far.yaml}}, {{scenario: {disk}}}]\nvary:\n  scenario: {{world: [quasistatic]}}\n"
    );
    let path = directory.join("two.yaml").display().to_string();
    fs::write(&path, text).unwrap();
    for (pictures, count) in [("none", 0), ("failed", 2), ("all", 2)] {
        let out = directory.join(pictures).display().to_string();
        let output = vibrissa(&["sweep", &path, "--out", &out, "--pictures", pictures]);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        let page = fs::read_to_string(directory.join(pictures).join("index.html")).unwrap();
        let links: Vec<&str> = page.split("href=\"runs/").skip(1).map(|rest| rest.split('"').next().unwrap()).collect();
        assert_eq!(links.len(), count, "{pictures}");
        for link in links {
            let picture = fs::read_to_string(directory.join(pictures).join("runs").join(link)).unwrap();
            assert!(picture.starts_with("<svg"), "{link}");
        }
    }
}

#[test]
fn the_changes_since_an_older_bench_need_that_bench() {
    let directory = directory("report-older");
    fs::write(directory.join("results.json"), "[{\"format\": \"tick\"}]").unwrap();
    let [older, out] = [directory.clone(), directory.join("new")].map(|path| path.display().to_string());
    let output = vibrissa(&["bench", "--ideal", "--out", &out, "--against", &older, "--simulator", "quasistatic"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("is no older report"), "{}", stderr(&output));
    assert!(!Path::new(&out).exists(), "the bench ran before the error");
}
