//! Properties in `vibrissa test`: what fails is found, made simple, shown and kept.

use std::fs;
use std::path::{Path, PathBuf};

use serde_json::Value;
use vibrissa::diagnostic::Source;
use vibrissa::scenario;

use super::program::{ROOT, directory, stderr, stdout, vibrissa};

/// The shipped policy that passes all convex corners, with changed text and a property, and with the standard library as
/// files beside it. A change is made in the file that contains its text.
fn mutated(folder: &str, changes: &[(&str, &str)], property: &str) -> PathBuf {
    let directory = directory(folder);
    let policies = Path::new(ROOT).join("policies");
    let library = fs::read_dir(policies.join("std")).unwrap().map(|entry| entry.unwrap().path());
    let mut files: Vec<(PathBuf, String)> = [policies.join("vibrissa.fsm")]
        .into_iter()
        .chain(library)
        .map(|path| {
            let text = with_local_library(&fs::read_to_string(&path).unwrap());
            (directory.join(path.file_name().unwrap()), text)
        })
        .collect();
    for (from, to) in changes {
        let (_, text) = files
            .iter_mut()
            .find(|(_, text)| text.contains(from))
            .unwrap_or_else(|| panic!("the policy no longer has `{from}`: plant the bug in another place"));
        *text = text.replace(from, to);
    }
    for (path, text) in &files {
        fs::write(path, text).unwrap();
    }
    let policy = directory.join("policy.fsm");
    fs::rename(directory.join("vibrissa.fsm"), &policy).unwrap();
    let text = fs::read_to_string(&policy).unwrap();
    fs::write(&policy, text + property).unwrap();
    policy
}

/// A policy or a library that uses files beside it in place of the standard library.
fn with_local_library(text: &str) -> String {
    let line = |line: &str| match line.strip_prefix("use std.") {
        Some(library) => {
            let (name, rest) = library.split_at(library.find(' ').unwrap_or(library.len()));
            format!("use \"{name}.fsm\"{rest}\n")
        }
        None => format!("{line}\n"),
    };
    text.lines().map(line).collect()
}

fn tested(policy: &Path, more: &[&str]) -> (Option<i32>, Value) {
    let policy = policy.to_str().unwrap();
    let arguments = ["test", policy, "--filter", "any corner", "--simulator", "quasistatic", "--json"];
    let output = vibrissa(&[&arguments[..], more].concat());
    let told = stderr(&output);
    let results: Value = serde_json::from_slice(&output.stdout).unwrap_or_else(|fault| panic!("{fault}: {told}"));
    (output.status.code(), results[0].clone())
}

fn value(result: &Value, name: &str) -> f64 {
    result["property"]["values"][name].as_f64().unwrap()
}

/// Checks that a failing case has no displacement of the start and no tilt, and one object.
fn assert_simplest(result: &Value) {
    for name in ["start_x", "start_y", "start_heading", "tilt"] {
        assert!(value(result, name).abs() < 1e-12, "{name}: {result}");
    }
    let text = result["property"]["scenario"].as_str().unwrap();
    let scene = scenario::read(&Source::new("scene.yaml", text)).unwrap();
    assert_eq!(scene.solids.len(), 1);
}

#[test]
fn a_wrong_sign_for_one_side_is_found_and_shrunk_to_that_side_alone() {
    let changes = [
        ("direction(travel_heading(w) + away * w.side)", "direction(travel_heading(w) - away)"),
        ("angle(tangent) - away * w.side", "angle(tangent) + away"),
    ];
    let property = "
property \"turns any corner\" over convex-corner(angle in 30 deg .. 150 deg, speed in 2 .. 10 cm/s) {
  expect run.completed and run.coverage > 0.9
}
";
    let (code, result) = tested(&mutated("planted-sign", &changes, property), &["--no-keep"]);
    assert_eq!(code, Some(1), "{result}");
    assert_simplest(&result);
    assert!((value(&result, "side") + 1.0).abs() < 1e-12);
    // The bug shows at every angle and every speed, so these have their simplest values.
    assert!((value(&result, "angle").to_degrees() - 90.0).abs() < 1e-4);
    assert!((value(&result, "speed") - 0.05).abs() < 1e-9);
}

/// A policy that gives up where the surface behind a corner differs by 10° to 40° from the surface before it. The angles
/// of the other corners of a scene are between 45° and 90°.
fn with_threshold(folder: &str) -> PathBuf {
    let more = "
monitor faces {
  var last   = 0 deg
  var any    = false
  var turned = 0 deg
  set turned = if any and is_straight(followed) then |turn(last, angle(followed.contour.tangent))| else 0 deg
  if is_straight(followed) { set last = angle(followed.contour.tangent)  set any = true }
}
let is_straight(w: whisker) =
    w.sense > 0 and w.contour.ready and |turn(angle(w.contour.tangent), angle(w.contour.tangent(15 mm)))| < 2 deg
always when faces.turned > 10 deg and faces.turned < 40 deg -> Failure(\"the corner is too flat\")

property \"turns any corner\" over convex-corner(angle in 30 deg .. 90 deg, speed in 2 .. 10 cm/s) {
  expect run.completed
}
";
    mutated(folder, &[], &more.replace("followed", "r0"))
}

#[test]
fn a_threshold_is_found_and_shrunk_to_its_boundary_and_the_case_is_kept() {
    let policy = with_threshold("planted-threshold");
    let (code, result) = tested(&policy, &[]);
    assert_eq!(code, Some(1), "{result}");
    assert_simplest(&result);
    let angle = value(&result, "angle").to_degrees();
    assert!((39.0..=41.0).contains(&angle), "{angle}");
    assert!(value(&result, "side") > 0.0);

    // The next run tries the kept case first, finds the same, and keeps nothing new.
    let kept = policy.with_file_name("policy.regressions.yaml");
    let text = fs::read_to_string(&kept).unwrap();
    let out = policy.with_file_name("out");
    let (code, again) = tested(&policy, &["--out", out.to_str().unwrap()]);
    assert_eq!(code, Some(1));
    for same in ["values", "scenario"] {
        assert_eq!(again["property"][same], result["property"][same]);
    }
    assert_eq!((again["property"]["kept"].as_u64(), again["property"]["cases"].as_u64()), (Some(1), Some(0)));
    assert_eq!(fs::read_to_string(&kept).unwrap(), text);

    // The files are the scenario and its run. Run by itself, the scenario fails in the same way.
    let file = |ending: &str| fs::read_to_string(out.join(format!("01-turns-any-corner.{ending}"))).unwrap();
    assert_eq!(file("yaml"), result["property"]["scenario"].as_str().unwrap());
    assert!(file("yaml").contains("convex_corner") && file("svg").trim_end().ends_with("</svg>"));
    let scene = out.join("01-turns-any-corner.yaml");
    let (scene, text) = (scene.to_str().unwrap(), policy.to_str().unwrap());
    let speed = "speed=50 mm/s";
    let run = ["run", scene, "--policy", text, "--set", speed, "--simulator", "quasistatic", "--json"];
    let output = vibrissa(&run);
    let run: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(run[0]["reason"], "the corner is too flat");
    let result: Value = serde_json::from_str(&file("json")).unwrap();
    for same in ["sim_s", "error_mm", "path_m", "states"] {
        assert!(!result[same].is_null() && result[same] == run[0][same], "{same}: {} {}", result[same], run[0][same]);
    }
}

/// A policy that always fails at once.
const QUICK: &str = "machine quick  param speed = 5 cm/s in 1 .. 10 cm/s  initial Going
state Going { steer body along direction(body.yaw) at speed turning 0 deg/s  after 0.1 s -> Failure(\"over\") }
";

fn quick(folder: &str, property: &str) -> PathBuf {
    let policy = directory(folder).join("policy.fsm");
    fs::write(&policy, format!("{QUICK}{property}\n")).unwrap();
    policy
}

#[test]
fn a_property_that_holds_tells_its_cases_and_keeps_nothing() {
    let policy =
        quick("property-holds", "property \"it ends\" over tunnel-mouth { expect run.failed and run.time < 1 s }");
    let text = policy.to_str().unwrap();
    let output = vibrissa(&["test", text, "--cases", "3", "--simulator", "quasistatic"]);
    assert_eq!((output.status.code(), stderr(&output)), (Some(0), String::new()));
    assert!(stdout(&output).contains("it ends (3 cases of tunnel-mouth, in "), "{}", stdout(&output));
    assert!(!policy.with_file_name("policy.regressions.yaml").exists());
}

#[test]
fn a_failing_property_is_shown_with_its_simplest_scene() {
    let policy = quick("property-fails", "property \"it goes on\" over polygon { expect not run.failed }");
    let output = vibrissa(&["test", policy.to_str().unwrap(), "--simulator", "quasistatic"]);
    let (code, told, shown) = (output.status.code(), stderr(&output), stdout(&output));
    assert_eq!(code, Some(1), "{told}");
    assert!(told.contains("the simplest case that fails: the simplest scene"), "{told}");
    assert!(told.contains("error[P0701]") && told.contains("policy.regressions.yaml"), "{told}");
    // What follows the comment is a scenario.
    let text: String = shown
        .lines()
        .filter(|line| !line.contains("polic") && !line.starts_with("1 test"))
        .fold(String::new(), |text, line| text + line + "\n");
    let scene = scenario::read(&Source::new("scene.yaml", text)).unwrap();
    assert_eq!((scene.name.as_str(), scene.solids.len()), ("polygon", 1));
}

#[test]
fn kept_cases_of_other_properties_and_outside_of_the_ranges_are_left_out() {
    let property = "property \"it goes on\" over thin-wall(thickness = 10 mm) { expect not run.failed }";
    let policy = quick("property-kept", property);
    let run = || vibrissa(&["test", policy.to_str().unwrap(), "--simulator", "quasistatic", "--json"]);
    let kept = || -> Value { serde_json::from_slice(&run().stdout).unwrap() };
    assert_eq!(kept()[0]["property"]["kept"], 0);
    assert_eq!(kept()[0]["property"]["kept"], 1);
    let file = policy.with_file_name("policy.regressions.yaml");
    let text = fs::read_to_string(&file).unwrap();
    for (from, to) in [("it goes on", "another"), ("thickness: 10 mm", "thickness: 11 mm"), ("thin-wall", "polygon")] {
        fs::write(&file, text.replace(from, to)).unwrap();
        assert_eq!(kept()[0]["property"]["kept"], 0, "{to}");
    }
    fs::write(&file, text.replace("values", "value")).unwrap();
    let output = run();
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("policy.regressions.yaml") && stderr(&output).contains("remove it"));
}
