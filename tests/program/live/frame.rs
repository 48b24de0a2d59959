//! What each tick of a run shows on the page: plots of the policy, coverage, periods, and the start before the first tick.

use std::fs;
use std::path::{Path, PathBuf};
use std::thread::sleep;
use std::time::Duration;

use serde_json::{Value, json};

use super::session::{SCENE, Session, Viewer};
use crate::command::program::{ROOT, directory, stderr, stdout, vibrissa};

/// A policy with a plot of each kind. One is set in a single tick, and one only now and then.
const PLOTS: &str = "machine plotter\nwhisker r0 by one_channel\ntype Side = left or right\nvar nearer = Side.left\ninitial Go\n\
    state Go {\n  plot bend = |r0.base_angle|\n  plot touches = r0.touching\n  plot side = nearer\n\
    entry { plot begun = time }\n  if r0.touching { plot touched = time }\n\
    steer body along direction(body.yaw) at 30 mm/s turning 0 deg/s\n  when time > 4 s -> Turn\n}\n\
    state Turn {\n  entry { set nearer = Side.right }\n  plot side = nearer\n\
    steer body along direction(body.yaw) at 10 mm/s turning 5 deg/s\n  after 15 s -> Go\n}\n";

/// A folder with the scene and a policy.
fn folder(name: &str, policy: &str) -> PathBuf {
    let folder = directory(name);
    fs::write(folder.join("scene.yaml"), SCENE).unwrap();
    fs::write(folder.join("policy.fsm"), policy).unwrap();
    folder
}

fn bang() -> String {
    fs::read_to_string(Path::new(ROOT).join("policies/bang.fsm")).unwrap()
}

const RUN: [&str; 8] = ["run", "scene.yaml", "--policy", "policy.fsm", "--live", "--paused", "--live-speed", "max"];

/// All ticks of a run until its end, also those that the connection has missed.
fn all_frames(page: &mut Viewer) -> Vec<Value> {
    page.send(&json!({"type": "run"}));
    let (status, _) = page.until_status("finished");
    page.send(&json!({"type": "range", "from": 0, "to": status["ticks"]}));
    let (history, _) = page.until(|message| message["type"] == "history");
    history["frames"].as_array().unwrap().clone()
}

/// The plots of a tick by their names, with the values as `run --ticks` writes them.
fn plots(hello: &Value, frame: &Value) -> Vec<(String, Value)> {
    let infos = hello["plots"].as_array().unwrap().iter();
    let set = infos.zip(frame["plots"].as_array().unwrap()).filter(|(_, value)| !value.is_null());
    let shown = |(info, value): (&Value, &Value)| {
        let choices = info["choices"].as_array().unwrap();
        let name = value
            .as_f64()
            .and_then(|index| choices.iter().zip(0..).find(|(_, own)| (f64::from(*own) - index).abs() < 0.5));
        let value = match name.and_then(|(name, _)| name.as_str()) {
            Some("false") => json!(false),
            Some("true") => json!(true),
            Some(name) => json!(name),
            None => value.clone(),
        };
        (info["name"].as_str().unwrap().to_owned(), value)
    };
    set.map(shown).collect()
}

#[test]
fn each_tick_has_the_plots_that_the_policy_has_set() {
    let folder = folder("live-plots", PLOTS);
    let written = folder.join("ticks.jsonl");
    let words = [&RUN[..], &["--ticks", "ticks.jsonl", "--record", "run.mcap"]].concat();
    let session = Session::start(&folder, &words);
    let (mut page, hello) = session.page();
    let expected = json!([
        {"name": "bend", "unit": "rad", "choices": []},
        {"name": "touches", "unit": "", "choices": ["false", "true"]},
        {"name": "side", "unit": "", "choices": ["left", "right"]},
        {"name": "begun", "unit": "s", "choices": []},
        {"name": "touched", "unit": "s", "choices": []},
    ]);
    let sorted = |plots: &Value| {
        let mut plots = plots.as_array().unwrap().clone();
        plots.sort_by_key(|plot| plot["name"].as_str().unwrap().to_owned());
        plots
    };
    assert_eq!(sorted(&hello["plots"]), sorted(&expected));
    let frames = all_frames(&mut page);
    session.until("Ctrl-C");
    let lines = fs::read_to_string(written).unwrap();
    let ticks: Vec<Value> = lines.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    assert_eq!(frames.len(), ticks.len());
    for (frame, tick) in frames.iter().zip(&ticks) {
        let line = |plot: &Value| (plot["plot"].as_str().unwrap().to_owned(), plot["value"].clone());
        let expected: Vec<_> = tick["plots"].as_array().unwrap().iter().map(line).collect();
        assert_eq!(plots(&hello, frame), expected, "tick {}", frame["tick"]);
    }
    let begun = hello["plots"].as_array().unwrap().iter().position(|plot| plot["name"] == "begun").unwrap();
    let count = |frames: &[Value]| frames.iter().filter(|frame| !frame["plots"][begun].is_null()).count();
    assert_eq!(count(&frames), 2, "the state is entered twice");

    // The value of a single tick is also among fewer ticks of the past.
    page.send(&json!({"type": "range", "from": 0, "to": frames.len(), "most": 50}));
    let (history, _) = page.until(|message| message["type"] == "history");
    assert_eq!(count(history["frames"].as_array().unwrap()), 2);

    // A replay and the loop of the robot show the same plots.
    for words in [&["replay", "run.mcap"][..], &["drive", "policy.fsm", "--emulate", "scene.yaml"]] {
        let options = ["--live", "--paused", "--live-speed", "max"];
        let session = Session::start(&folder, &[words, &options].concat());
        let (mut page, other) = session.page();
        assert_eq!(other["plots"], hello["plots"], "{words:?}");
        assert!(all_frames(&mut page).iter().any(|frame| !frame["plots"][begun].is_null()), "{words:?}");
    }
}

#[test]
fn the_coverage_of_a_tick_is_that_of_a_run_until_then_however_fast_the_run_is() {
    let folder = folder("live-coverage", &bang());
    let session = Session::start(&folder, &RUN);
    let (mut page, _) = session.page();
    let frames = all_frames(&mut page);
    let coverage = |frame: &Value| frame["metrics"]["coverage"].as_f64().unwrap();
    assert_eq!(frames[0]["metrics"]["coverage"], 0.0);
    assert!(frames.is_sorted_by(|before, after| coverage(before) <= coverage(after) + 1e-12));
    for seconds in [12, 20, 25] {
        let shorter = folder.join(format!("{seconds}.yaml"));
        fs::write(&shorter, SCENE.replace("time: 25 s", &format!("time: {seconds} s"))).unwrap();
        let policy = folder.join("policy.fsm");
        let output = vibrissa(&["run", shorter.to_str().unwrap(), "--policy", policy.to_str().unwrap(), "--json"]);
        let result: Value = serde_json::from_str(&stdout(&output)).unwrap();
        let expected = result[0]["coverage"].as_f64().unwrap();
        let shown = coverage(&frames[30 * seconds - 1]);
        assert!(expected > 0.01 && (shown - expected).abs() < 1e-4, "{seconds} s: {shown}, and not {expected}");
    }
}

#[test]
fn a_pause_is_no_control_period() {
    let folder = folder("live-period", &bang());
    let session = Session::start(&folder, &RUN);
    let (mut page, _) = session.page();
    page.until_status("paused");
    let mut step = |ticks: u64, count: u64| {
        // Longer than any tick takes.
        sleep(Duration::from_millis(1500));
        page.send(&json!({"type": "step", "ticks": ticks}));
        page.until(|message| message["type"] == "status" && message["state"] == "paused" && message["ticks"] == count)
            .1
            .frames
    };
    let periods = |frames: Vec<Value>| -> Vec<Option<f64>> {
        assert!(frames.iter().all(|frame| frame["loop"]["used"].is_f64()), "each tick has a time of execution");
        frames.iter().map(|frame| frame["loop"]["period"].as_f64()).collect()
    };
    let is_short = |period: &Option<f64>| period.is_some_and(|period| period < 1.0);
    for (ticks, count) in [(1, 1), (1, 2), (5, 7)] {
        let periods = periods(step(ticks, count));
        assert!(periods[0].is_none() && periods[1..].iter().all(is_short), "{periods:?}");
    }
    // The same at a breakpoint.
    page.send(&json!({"type": "break", "add": "time > 1 s"}));
    page.send(&json!({"type": "run"}));
    page.until(|message| message["type"] == "status" && message["breakpoint"] == "time > 1 s");
    sleep(Duration::from_millis(1500));
    let frames = all_frames(&mut page);
    let after = frames.iter().position(|frame| frame["time"].as_f64().unwrap() > 1.0).unwrap() + 1;
    let periods = periods(frames);
    assert_eq!(periods[after], None);
    assert!(periods[7..].iter().flatten().all(|period| *period < 1.0), "{periods:?}");
    assert_eq!(periods[8..].iter().filter(|period| period.is_none()).count(), 1);
}

#[test]
fn a_page_knows_the_start_pose_before_the_first_tick() {
    let folder = folder("live-start", &bang());
    let [scene, policy, file] =
        ["scene.yaml", "policy.fsm", "run.mcap"].map(|name| folder.join(name).to_str().unwrap().to_owned());
    let output = vibrissa(&["run", &scene, "--policy", &policy, "--record", &file]);
    assert!(matches!(output.status.code(), Some(0 | 1)), "{}", stderr(&output));
    let commands = [
        &["run", "scene.yaml", "--policy", "policy.fsm"][..],
        &["drive", "policy.fsm", "--emulate", "scene.yaml"],
        // The scene of this recording is not known, but the first pose is.
        &["replay", "run.mcap"],
    ];
    for words in commands {
        let session = Session::start(&folder, &[words, &["--live", "--paused"]].concat());
        let (mut page, hello) = session.page();
        let (_, ticks) = page.until_status("paused");
        assert_eq!(ticks.frames.len(), 0);
        let start: Vec<f64> = hello["start"].as_array().unwrap().iter().map(|part| part.as_f64().unwrap()).collect();
        let expected = [0.0, 0.072, std::f64::consts::FRAC_PI_2];
        assert!(start.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-3), "{words:?}: {start:?}");
        if words[0] == "replay" {
            let frames = all_frames(&mut page);
            let is_timed = |frame: &Value| !frame["loop"].is_null();
            assert!(
                !frames.is_empty() && !frames.iter().any(is_timed),
                "wall times of a replay are those of another computer"
            );
        }
    }
}
