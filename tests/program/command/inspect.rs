//! `vibrissa run --break`, `--transitions`, and `vibrissa inspect diff`

use serde_json::Value;

use super::program::{directory, stderr, stdout, vibrissa};

const BOX: [&str; 4] = ["scenarios/box.yaml", "--simulator", "quasistatic", "--policy"];

#[test]
fn a_run_stops_at_a_breakpoint_and_shows_its_guards() {
    let arguments = [&["run"], &BOX[..], &["policies/thesis.fsm", "--break", "Meeting"]].concat();
    let output = vibrissa(&arguments);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let shown = stdout(&output);
    assert!(shown.contains("breakpoint `Meeting`") && shown.contains("Exploring"), "{shown}");
    let output = vibrissa(&[&arguments[..], &["--json"]].concat());
    let stops: Value = serde_json::from_str(&stdout(&output)).unwrap();
    assert_eq!((&stops[0]["format"], &stops[0]["states"][1]), (&"stop".into(), &"Meeting".into()), "{stops}");
}

#[test]
fn every_transition_is_a_line_of_json() {
    let folder = directory("transitions");
    let [file, ticks] = ["transitions.jsonl", "ticks.jsonl"].map(|name| folder.join(name));
    let [path, tick_path] = [&file, &ticks].map(|file| file.display().to_string());
    let options = ["policies/thesis.fsm", "--transitions", &path, "--ticks", &tick_path];
    let output = vibrissa(&[&["run"], &BOX[..], &options].concat());
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let ticks = std::fs::read_to_string(ticks).unwrap();
    assert!(ticks.lines().count() > 1000 && ticks.lines().all(|line| line.contains(r#""format":"tick""#)));
    let lines = std::fs::read_to_string(file).unwrap();
    let lines: Vec<Value> = lines.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    assert!(lines.len() > 20 && lines.iter().all(|line| line["format"] == "transition"));
}

#[test]
fn a_compiled_machine_has_no_guards_to_show() {
    let machine = directory("machine").join("thesis.machine").display().to_string();
    assert_eq!(vibrissa(&["compile", "policies/thesis.fsm", "-o", &machine]).status.code(), Some(0));
    let output = vibrissa(&[&["run"], &BOX[..], &[&machine, "--break", "Meeting"]].concat());
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("give its policy"), "{}", stderr(&output));
}

#[test]
fn diff_has_exit_status_1_for_policies_that_differ() {
    let diff = |other: &str| {
        let arguments =
            ["inspect", "diff", "policies/thesis.fsm", other, "scenarios/box.yaml", "--simulator", "quasistatic"];
        let output = vibrissa(&arguments);
        (output.status.code(), stdout(&output))
    };
    let (status, shown) = diff("policies/thesis.fsm");
    assert!(status == Some(0) && shown.contains("equal in all"), "{shown}");
    let (status, shown) = diff("policies/baseline.fsm");
    assert!(status == Some(1) && shown.contains("the first difference is in tick"), "{shown}");
}

#[cfg(feature = "live")]
#[test]
fn a_breakpoint_ends_no_run_that_is_watched_or_recorded() {
    for words in [&["--watch"][..], &["--record", "run.mcap"]] {
        let arguments = [&["run", "scenarios/box.yaml", "--break", "Meeting"], words].concat();
        let output = vibrissa(&arguments);
        assert_eq!(output.status.code(), Some(2), "{words:?}");
        assert!(stderr(&output).contains("add --live"), "{}", stderr(&output));
    }
}

#[test]
fn a_guard_with_a_time_shows_how_much_of_it_has_elapsed() {
    let folder = directory("elapsed");
    let steer = "steer body along direction(body.yaw) at 10 mm/s turning 0 deg/s";
    let policy = format!(
        "machine late\nwhisker r0\ninitial Go\nstate Go {{\n  {steer}\n  after 15 s -> Late\n  \
         when time > 1.5 s for 5 s -> Late\n  when time > 60 s for 1 s -> Late\n}}\nstate Late {{ stop }}\n"
    );
    let path = folder.join("late.fsm").display().to_string();
    std::fs::write(&path, policy).unwrap();
    let arguments = [&["run"], &BOX[..], &[&path, "--break", "time > 2 s"]].concat();
    let shown = stdout(&vibrissa(&arguments));
    // Each line has the time that has elapsed since the entry of the state, or since the condition holds.
    for missing in ["2 s of 15 s elapsed", "500 ms of 5 s elapsed", "`time > 60 s` by 57.9667 s"] {
        assert!(shown.contains(missing), "{missing}: {shown}");
    }
}
