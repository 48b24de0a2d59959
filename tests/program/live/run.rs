//! Runs on the page: their ticks, pauses and breakpoints.

use std::fs;

use serde_json::{Value, json};

use super::session::{SCENE, Session};
use crate::command::program::{ROOT, directory, stdout, vibrissa, without_origin};

const POLICY: &str = "policies/bang.fsm";

/// A folder with the scene and the policy.
fn folder(name: &str) -> std::path::PathBuf {
    let folder = directory(name);
    fs::write(folder.join("scene.yaml"), SCENE).unwrap();
    fs::copy(std::path::Path::new(ROOT).join(POLICY), folder.join("policy.fsm")).unwrap();
    folder
}

const RUN: [&str; 6] = ["run", "scene.yaml", "--policy", "policy.fsm", "--live", "--json"];

/// The keys of a result that depend neither on the machine's speed nor on the command.
fn without_times(mut result: Value) -> Value {
    let result = result[0].as_object_mut().unwrap();
    result.retain(|key, _| !["start_s", "wall_s", "realtime", "tick_us", "provenance"].contains(&key.as_str()));
    Value::Object(result.clone())
}

#[test]
fn a_page_gets_the_run_from_its_beginning_to_its_outcome() {
    let folder = folder("live-run");
    let session = Session::start(&folder, &[&RUN[..], &["--paused", "--live-speed", "max"]].concat());
    let (mut page, hello) = session.page();
    assert_eq!(
        (&hello["scenario"], &hello["policy"], &hello["command"]),
        (&"scene".into(), &"bang".into(), &"run".into())
    );
    assert!(hello["scene"][0]["points"].as_array().unwrap().len() >= 4);
    page.until_status("paused");
    page.send(&json!({"type": "run"}));
    let (status, ticks) = page.until_status("finished");
    assert_eq!((&status["verdict"], &status["ticks"]), (&"completed".into(), &750.into()));
    assert_eq!(ticks.frames.len() as u64 + ticks.lost, 750, "every tick is received or counted");
    let touches =
        |frame: &&Value| frame["whiskers"].as_array().unwrap().iter().any(|whisker| whisker["touching"] == true);
    let frame = ticks.frames.iter().find(touches).unwrap();
    assert!(frame["guards"].as_array().is_some_and(|guards| !guards.is_empty()), "{frame}");
    // The last frame is that of the result.
    let last = ticks.frames.last().unwrap();
    let mean = session.json()[0]["error_mm"]["mean"].as_f64().unwrap();
    let shown = 1e3 * last["metrics"]["error"].as_f64().unwrap();
    assert!((mean - shown).abs() < 1e-9, "{mean} mm, {shown} mm");
    // Ticks that were lost are in the history, with all recorded tips.
    page.send(&json!({"type": "range", "from": 0, "to": 750, "most": 100}));
    let (history, _) = page.until(|message| message["type"] == "history");
    let tips = |frames: &Value| {
        frames.as_array().unwrap().iter().map(|frame| frame["contour"].as_array().unwrap().len()).sum::<usize>()
    };
    let thinned = tips(&history["frames"]);
    assert!(history["frames"].as_array().unwrap().len() <= 101);
    page.send(&json!({"type": "range", "from": 0, "to": 750}));
    let (history, _) = page.until(|message| message["type"] == "history");
    assert_eq!((history["frames"].as_array().unwrap().len(), tips(&history["frames"])), (750, thinned));
}

#[test]
fn a_chart_names_the_behaviours_of_states_with_their_arguments() {
    let folder = folder("live-behaviours");
    let policy = std::path::Path::new(ROOT).join("policies/quick.fsm");
    let session =
        Session::start(&folder, &["run", "scene.yaml", "--policy", policy.to_str().unwrap(), "--live", "--paused"]);
    let (_, hello) = session.page();
    let states = hello["chart"]["states"].as_array().unwrap();
    let behaviour = |name: &str| states.iter().find(|state| state["name"] == name).unwrap()["behaviour"].clone();
    assert_eq!(behaviour("Meeting"), "slide_on(w, target / 2, speed / 2, lost_for)");
    assert_eq!(behaviour("Retrieval"), Value::Null, "the policy has the content of this state itself");
}

#[test]
fn a_stalled_viewer_loses_ticks_and_the_run_none() {
    let folder = folder("live-stalled");
    let words =
        [&RUN[..], &["--paused", "--live-speed", "max", "--ticks", "live.jsonl", "--record", "live.mcap"]].concat();
    let session = Session::start(&folder, &words);
    let (mut stalled, _) = session.page();
    let (mut page, _) = session.page();
    page.send(&json!({"type": "run"}));
    page.until_status("finished");
    let shown = session.json();
    // Only now does the first one read.
    let (_, ticks) = stalled.until_status("finished");
    assert!(ticks.lost > 0, "it has all {} ticks", ticks.frames.len());
    assert_eq!(ticks.frames.len() as u64 + ticks.lost, 750);
    let (scene, policy) = (folder.join("scene.yaml"), folder.join("policy.fsm"));
    let plain_ticks = folder.join("plain.jsonl");
    let [scene, policy, file] = [&scene, &policy, &plain_ticks].map(|path| path.to_str().unwrap());
    let plain = vibrissa(&["run", scene, "--policy", policy, "--json", "--ticks", file]);
    let plain: Value = serde_json::from_str(&stdout(&plain)).unwrap();
    assert_eq!(without_times(shown), without_times(plain));
    session.until("Ctrl-C");
    let ticks = |path: std::path::PathBuf| without_origin(&fs::read_to_string(path).unwrap());
    assert_eq!(ticks(folder.join("live.jsonl")), ticks(plain_ticks));
    let replayed = vibrissa(&["replay", folder.join("live.mcap").to_str().unwrap()]);
    assert_eq!(replayed.status.code(), Some(0), "a run on the page is recorded as any other");
}

#[test]
fn a_run_is_paused_stepped_and_stopped_at_breakpoints() {
    let folder = folder("live-pause");
    let session = Session::start(&folder, &[&RUN[..], &["--paused", "--live-speed", "max"]].concat());
    let (mut page, _) = session.page();
    let (status, ticks) = page.until_status("paused");
    assert_eq!((&status["reason"], ticks.frames.len()), (&"start".into(), 0));
    page.send(&json!({"type": "step", "ticks": 3}));
    let (_, ticks) =
        page.until(|message| message["type"] == "status" && message["state"] == "paused" && message["ticks"] == 3);
    let numbers: Vec<_> = ticks.frames.iter().map(|frame| frame["tick"].as_u64().unwrap()).collect();
    assert_eq!((numbers, ticks.lost), (vec![0, 1, 2], 0));

    // A condition that is added while the run is paused.
    page.send(&json!({"type": "break", "add": "time > 1 s"}));
    let has_breakpoint = |message: &Value| message["breakpoints"].as_array().is_some_and(|all| all.len() == 1);
    page.until(|message| message["type"] == "status" && has_breakpoint(message));
    page.send(&json!({"type": "run"}));
    let at = |text: &'static str| move |message: &Value| message["type"] == "status" && message["breakpoint"] == text;
    let (status, ticks) = page.until(at("time > 1 s"));
    assert_eq!(status["reason"], "breakpoint");
    let times: Vec<f64> = ticks.frames.iter().map(|frame| frame["time"].as_f64().unwrap()).collect();
    let [.., before, last] = times[..] else { panic!("{times:?}") };
    assert!(before <= 1.0 && last > 1.0, "{before} {last}");

    // A condition that goes on holding does not stop the run again. A state and a transition stop it where they are entered and taken.
    for text in ["Following", "Exploring: r0.touching"] {
        page.send(&json!({"type": "break", "add": text}));
    }
    page.send(&json!({"type": "run"}));
    let (_, ticks) = page.until(at("Following"));
    let last = ticks.frames.last().unwrap();
    assert_eq!(last["taken"].as_array().unwrap().len(), 1, "{last}");

    page.send(&json!({"type": "break", "add": "r0.deflecton > 1 rad"}));
    let (error, _) = page.until(|message| message["type"] == "error");
    assert!(error["message"].as_str().unwrap().contains("deflecton"), "{error}");
    page.send(&json!({"type": "nonsense"}));
    page.until(|message| message["type"] == "error");
    page.send(&json!({"type": "run"}));
    page.until_status("finished");
}

#[test]
fn a_breakpoint_is_set_before_the_start_and_survives_a_new_run() {
    let folder = folder("live-watch");
    let words = [
        "run",
        "scene.yaml",
        "--policy",
        "policy.fsm",
        "--live",
        "--live-speed",
        "max",
        "--watch",
        "--break",
        "Following",
    ];
    let session = Session::start(&folder, &words);
    let (mut page, hello) = session.page();
    assert_eq!((&hello["run"], &hello["breakpoints"][0]["text"]), (&1.into(), &"Following".into()));
    let is_stop = |message: &Value| message["type"] == "status" && message["breakpoint"] == "Following";
    page.until(is_stop);
    page.send(&json!({"type": "break", "add": "time > 2 s"}));
    page.until(|message| message["type"] == "status" && message["breakpoints"].as_array().unwrap().len() == 2);

    // A paused run ends when a file is saved.
    let text = fs::read_to_string(folder.join("policy.fsm")).unwrap();
    fs::write(folder.join("policy.new"), text.replace("Following", "Along")).unwrap();
    fs::rename(folder.join("policy.new"), folder.join("policy.fsm")).unwrap();
    let (hello, _) = page.until(|message| message["type"] == "hello");
    let texts: Vec<_> =
        hello["breakpoints"].as_array().unwrap().iter().map(|one| one["text"].as_str().unwrap()).collect();
    assert_eq!(
        (&hello["run"], texts),
        (&2.into(), vec!["time > 2 s"]),
        "the policy has no state of the other name any more"
    );
    page.until(|message| message["type"] == "status" && message["breakpoint"] == "time > 2 s");

    fs::write(folder.join("policy.new"), text).unwrap();
    fs::rename(folder.join("policy.new"), folder.join("policy.fsm")).unwrap();
    let (hello, _) = page.until(|message| message["type"] == "hello");
    assert_eq!((&hello["run"], hello["breakpoints"].as_array().unwrap().len()), (&3.into(), 2));
}

#[test]
fn a_run_of_the_robots_loop_shows_its_guards() {
    let folder = folder("live-drive");
    let words =
        ["drive", "policy.fsm", "--emulate", "scene.yaml", "--live", "--live-speed", "max", "--paused", "--json"];
    let session = Session::start(&folder, &words);
    let (mut page, hello) = session.page();
    assert_eq!((&hello["command"], &hello["capabilities"]["closed_loop"]), (&"drive".into(), &false.into()));
    page.send(&json!({"type": "run"}));
    let (status, ticks) = page.until_status("finished");
    assert!(ticks.frames.iter().all(|frame| !frame["guards"].as_array().unwrap().is_empty()));
    let result = session.json();
    assert_eq!(result["run"]["outcome"], status["verdict"], "{result}");
}

#[test]
fn the_recording_of_a_robot_shows_what_the_robot_did_with_the_text_of_its_machine() {
    let folder = folder("live-robot");
    let driven = ["drive", "policy.fsm", "--emulate", "scene.yaml", "--record", "robot.mcap", "--json"];
    let watched = ["--live", "--live-speed", "max", "--paused"];
    let shown = |words: &[&str]| {
        let session = Session::start(&folder, words);
        let (mut page, hello) = session.page();
        page.send(&json!({"type": "run"}));
        let (_, ticks) = page.until_status("finished");
        (session.json(), hello, ticks.frames)
    };
    let driven = shown(&[&driven[..], &watched].concat());
    let replayed = ["replay", "robot.mcap", "--policy", "policy.fsm", "--scenario", "scene.yaml", "--json"];
    let replayed = shown(&[&replayed[..], &watched].concat());
    assert!(replayed.0["difference"].is_null(), "{}", replayed.0);
    assert_eq!(replayed.1["scene"], driven.1["scene"]);
    // A page that does not keep pace misses ticks.
    let mut shared = 0;
    for driven in &driven.2 {
        let Some(replayed) = replayed.2.iter().find(|replayed| replayed["tick"] == driven["tick"]) else { continue };
        shared += 1;
        for key in ["states", "command", "guards", "plots"] {
            assert_eq!(driven[key], replayed[key], "{key} in tick {}", driven["tick"]);
        }
    }
    assert!(shared > 100, "{shared} of {} and {} ticks", driven.2.len(), replayed.2.len());

    let text = fs::read_to_string(folder.join("policy.fsm")).unwrap();
    fs::write(folder.join("other.fsm"), text.replacen("when ", "when 1 > 0 and ", 1)).unwrap();
    let words = ["replay", "robot.mcap", "--live", "--policy", "other.fsm"];
    let output = std::process::Command::new(env!("CARGO_BIN_EXE_vibrissa")).args(words).current_dir(&folder).output();
    let output = output.unwrap();
    let told = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{told}");
    assert!(told.contains("other.fsm: it does not compile to the recorded machine"), "{told}");
}
