//! `vibrissa setup services`

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use serde_json::Value;

use super::program::{ROOT, directory, stderr, stdout, vibrissa};

/// The files of a folder, by their paths below it.
fn files(folder: &Path) -> BTreeSet<PathBuf> {
    let mut found = BTreeSet::new();
    let mut open = vec![folder.to_owned()];
    while let Some(next) = open.pop() {
        for entry in fs::read_dir(next).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                open.push(path);
            } else {
                found.insert(path.strip_prefix(folder).unwrap().to_owned());
            }
        }
    }
    found
}

fn generate(name: &str, options: &[&str]) -> PathBuf {
    let folder = directory(name);
    let policy = format!("{ROOT}/policies/thesis.fsm");
    let out = folder.to_str().unwrap();
    let output = vibrissa(&[&["setup", "services", "generate", &policy, "--out", out], options].concat());
    assert!(output.status.success(), "{}", stderr(&output));
    assert!(stdout(&output).contains("next: copy env.example to .env"), "{}", stdout(&output));
    folder
}

#[test]
fn the_files_in_deploy_are_those_of_the_thesis_on_the_array_of_the_example() {
    let config = format!("{ROOT}/deploy/pi/array.yaml");
    let folder = generate("services-thesis", &["--config", &config]);
    let deploy = Path::new(ROOT).join("deploy");
    for file in files(&folder) {
        let (made, kept) = (fs::read_to_string(folder.join(&file)).unwrap(), deploy.join(&file));
        if std::env::var("INSTA_UPDATE").is_ok_and(|update| update == "always") {
            fs::create_dir_all(kept.parent().unwrap()).unwrap();
            fs::write(&kept, &made).unwrap();
        }
        let kept = fs::read_to_string(kept).unwrap_or_default();
        assert!(
            kept == made,
            "{} is old; run `INSTA_UPDATE=always cargo test --test program services`",
            file.display()
        );
    }
    let services: BTreeSet<_> =
        files(&deploy.join("services")).into_iter().map(|file| Path::new("services").join(file)).collect();
    assert!(services.is_subset(&files(&folder)), "{services:?}");
}

#[test]
fn the_dashboard_has_the_states_of_the_policy_and_the_limits_of_the_robot() {
    let folder = generate("services-dashboard", &["--name", "other"]);
    let text = fs::read_to_string(folder.join("services/grafana/dashboards/robot.json")).unwrap();
    let dashboard: Value = serde_json::from_str(&text).unwrap();
    let panels = dashboard["panels"].as_array().unwrap();
    let panel = |title: &str| panels.iter().find(|panel| panel["title"] == title).unwrap();

    let mapped = panel("State")["fieldConfig"]["defaults"]["mappings"][0]["options"].as_object().unwrap();
    let mapped: BTreeSet<&str> = mapped.keys().map(String::as_str).collect();
    let machine = folder.join("thesis.machine");
    let policy = format!("{ROOT}/policies/thesis.fsm");
    assert!(vibrissa(&["compile", &policy, "--out", machine.to_str().unwrap()]).status.success());
    let artifact = vibrissa_runtime::machine::Artifact::from_bytes(&fs::read(&machine).unwrap()).unwrap();
    let states: BTreeSet<&str> = artifact.program.states.iter().map(|state| &*state.name).collect();
    assert_eq!(mapped, states);
    let alloy = fs::read_to_string(folder.join("services/alloy.alloy")).unwrap();
    assert!(states.iter().all(|state| alloy.contains(state)) && alloy.contains("robot = \"other\""));

    let limits: Vec<f64> = panel("Base angles")["fieldConfig"]["defaults"]["thresholds"]["steps"]
        .as_array()
        .unwrap()
        .iter()
        .filter_map(|step| step["value"].as_f64())
        .collect();
    assert_eq!(limits, [-1.05e-3, 1.05e-3]);
    assert_eq!(dashboard["templating"]["list"][0]["current"]["value"], "other");
    let policy = panel("Policy")["options"]["content"].as_str().unwrap();
    for parameter in &artifact.program.parameters {
        assert!(policy.contains(&format!("| {} |", parameter.name)), "{}", parameter.name);
    }

    let ids: BTreeSet<u64> = panels.iter().map(|panel| panel["id"].as_u64().unwrap()).collect();
    assert_eq!(ids.len(), panels.len());
    // Panels do not overlap, and are within the 24 units of the grid.
    let mut used = BTreeSet::new();
    for panel in panels {
        let place = |key: &str| panel["gridPos"][key].as_u64().unwrap();
        assert!(place("x") + place("w") <= 24);
        for x in place("x")..place("x") + place("w") {
            for y in place("y")..place("y") + place("h") {
                assert!(used.insert((x, y)), "{} at {x} {y}", panel["title"]);
            }
        }
    }
}

#[test]
fn nothing_starts_without_passwords_or_listens_beyond_the_loopback_interface() {
    let compose = fs::read_to_string(Path::new(ROOT).join("deploy/compose.yaml")).unwrap();
    let parsed: Value = serde_yaml::from_str(&compose).unwrap();
    for (name, service) in parsed["services"].as_object().unwrap() {
        let image = service["image"].as_str().unwrap();
        let tag = image.rsplit_once(':').unwrap().1;
        assert!(tag.contains(|c: char| c.is_ascii_digit()) && tag.contains('.'), "{name}: {image} has no version");
        assert_eq!(service["restart"], "unless-stopped", "{name}");
        for port in service["ports"].as_array().into_iter().flatten() {
            assert!(port.as_str().unwrap().contains(":-127.0.0.1}:"), "{name}: {port}");
        }
        for (variable, value) in service["environment"].as_object().into_iter().flatten() {
            if variable.contains("PASSWORD") {
                assert!(value.as_str().unwrap().ends_with(":?set it in .env}"), "{name}: {variable}");
            }
        }
        for volume in service["volumes"].as_array().into_iter().flatten() {
            let source = volume.as_str().unwrap().split(':').next().unwrap();
            let is_named = parsed["volumes"].get(source).is_some();
            let file = Path::new(ROOT).join("deploy").join(source);
            assert!(is_named || !source.starts_with("./") || file.exists(), "{name}: {source}");
        }
    }
    let example = fs::read_to_string(Path::new(ROOT).join("deploy/env.example")).unwrap();
    let variables: BTreeSet<&str> = example.lines().filter_map(|line| Some(line.split_once('=')?.0)).collect();
    for part in compose.split("${").skip(1) {
        let variable = part.split([':', '}']).next().unwrap();
        assert!(variables.contains(variable), "{variable} is not in env.example");
    }
    for line in example.lines().filter(|line| line.contains("PASSWORD=")) {
        assert!(line.ends_with('='), "{line}");
    }
}

#[test]
fn a_wrong_name_and_a_file_without_messages_are_refused_and_messages_become_lines() {
    let folder = directory("services-lines");
    let out = folder.join("out");
    let policy = format!("{ROOT}/policies/thesis.fsm");
    let output = vibrissa(&["setup", "services", "generate", &policy, "--out", out.to_str().unwrap(), "--name", "a/b"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("use letters, digits"), "{}", stderr(&output));
    assert!(!out.exists());

    let messages = folder.join("messages.txt");
    let read = || vibrissa(&["setup", "services", "lines", messages.to_str().unwrap()]);
    fs::write(&messages, "nothing\n").unwrap();
    assert_eq!(read().status.code(), Some(2));
    fs::write(&messages, "1.5 vibrissa/array/status online\n").unwrap();
    assert_eq!(stdout(&read()), "vibrissa_status,robot=array value=\"online\" 1500000000\n");
}
