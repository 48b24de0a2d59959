//! Explicit values of families' parameters, in `vibrissa families` and in sweeps.

use std::fs;

use serde_json::Value;

use super::program::{ROOT, directory, stderr, stdout, vibrissa};

#[test]
fn a_given_parameter_is_the_same_in_all_scenes() {
    let output = vibrissa(&["families", "convex-corner", "--count", "4", "--print", "--with", "angle=40 deg"]);
    let shown = stdout(&output);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert_eq!(shown.matches("angle: 40.0000 deg").count(), 4);
    let objects: Vec<_> = shown.lines().filter(|line| line.contains("convex_corner:")).collect();
    assert!(objects.len() == 4 && objects.windows(2).all(|pair| pair[0] != pair[1]), "{objects:?}");
}

#[test]
fn families_with_long_runs_run_only_by_name() {
    let printed = |names: &[&str]| {
        let output = vibrissa(&[&["families"], names, &["--count", "1", "--print"]].concat());
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        let lines = stdout(&output);
        let families = lines.lines().filter_map(|line| line.strip_prefix("# trial 0 of ")?.split(',').next());
        families.map(str::to_owned).collect::<Vec<_>>()
    };
    assert_eq!(printed(&["shapes", "rooms"]), ["shapes", "rooms"]);
    let default = printed(&[]);
    assert!(default.len() == 8 && default.iter().all(|name| name != "shapes" && name != "rooms"), "{default:?}");
}

#[test]
fn a_value_that_a_family_does_not_have_is_unusable() {
    for (given, told) in [
        ("angel=40 deg", "there is no such parameter; there are start_x"),
        ("angle=40 mm", "such as \"90 deg\""),
        ("angle=200 deg", "must be from 10 deg to 180 deg"),
        ("side=0", "must be -1 or 1"),
    ] {
        let output = vibrissa(&["families", "convex-corner", "--count", "1", "--with", given]);
        assert_eq!(output.status.code(), Some(2), "{given}");
        assert!(stderr(&output).contains(told), "{given}: {}", stderr(&output));
    }
}

#[test]
fn a_sweep_varies_a_parameter_of_its_families() {
    let directory = directory("sweep-family");
    let text = format!(
        "name: angles\npolicies: [{ROOT}/policies/vibrissa.fsm]\nscenes: [{{family: convex-corner}}]\nvary:\n  \
         family: {{angle: [40 deg, 50 deg]}}\n  scenario: {{world: [quasistatic], stop: [{{time: 1 s}}]}}\n"
    );
    let (path, out) = (directory.join("angles.yaml"), directory.join("out"));
    fs::write(&path, text).unwrap();
    let output = vibrissa(&["sweep", path.to_str().unwrap(), "--jobs", "1", "--out", out.to_str().unwrap()]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let results = fs::read_to_string(out.join("results.jsonl")).unwrap();
    let results = results.lines().skip(1).map(|line| serde_json::from_str::<Value>(line).unwrap());
    let about: Vec<_> = results.map(|result| (result["settings"]["angle"].clone(), result["about"].clone())).collect();
    assert_eq!(about.len(), 2);
    for (angle, said) in [("40 deg", "a corner that turns by 40.0°"), ("50 deg", "a corner that turns by 50.0°")] {
        assert!(about.contains(&(angle.into(), said.into())), "{about:?}");
    }
}

#[test]
fn a_file_is_a_family_and_its_scenes_can_be_printed_and_swept() {
    let directory = directory("written-family");
    let file = format!("{ROOT}/scenarios/families/posts.yaml");
    let output = vibrissa(&["families", &file, "--count", "2", "--print"]);
    let shown = stdout(&output);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert!(shown.contains("name: posts-0") && shown.contains("name: posts-1") && !shown.contains('$'), "{shown}");
    let text = format!(
        "name: posts\npolicies: [{ROOT}/policies/vibrissa.fsm]\nscenes: [{{scenario: {file}, trials: 2}}]\nvary:\n  \
         scenario: {{world: [quasistatic], stop: [{{time: 1 s}}], expect: [{{}}]}}\n"
    );
    let (path, out) = (directory.join("posts.yaml"), directory.join("out"));
    fs::write(&path, text).unwrap();
    let output = vibrissa(&["sweep", path.to_str().unwrap(), "--jobs", "1", "--out", out.to_str().unwrap()]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let results = fs::read_to_string(out.join("results.jsonl")).unwrap();
    let scenes = results.lines().skip(1).map(|line| serde_json::from_str::<Value>(line).unwrap()["scenario"].clone());
    assert_eq!(scenes.collect::<Vec<_>>(), ["posts-0", "posts-1"]);
    let output = vibrissa(&["run", &file]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("`vibrissa families FILE` runs it"), "{}", stderr(&output));
    let output = vibrissa(&["families", &format!("{ROOT}/scenarios/disk.yaml")]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("has no section `draw`"), "{}", stderr(&output));
}
