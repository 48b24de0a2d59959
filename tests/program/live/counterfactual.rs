//! What a changed policy would have done, compared with runs of the changed policy itself.

use std::fs;
use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use super::session::{SCENE, Session};
use crate::command::program::{ROOT, directory, stderr, stdout, vibrissa};

const POLICY: &str = "policies/bang.fsm";

/// A folder with the scene, the policy and a recorded run of it.
fn recorded(name: &str) -> PathBuf {
    let folder = directory(name);
    fs::write(folder.join("scene.yaml"), SCENE).unwrap();
    fs::copy(Path::new(ROOT).join(POLICY), folder.join("policy.fsm")).unwrap();
    let output = run(&folder, &["--record", "run.mcap"]);
    assert!(matches!(output.status.code(), Some(0 | 1)), "{}", stderr(&output));
    folder
}

/// Runs the scene under the policy. The paths of `words` are in the folder.
fn run(folder: &Path, words: &[&str]) -> std::process::Output {
    let path = |name: &str| folder.join(name).to_str().unwrap().to_owned();
    let inside = |word: &&str| if word.contains('.') && !word.contains('=') { path(word) } else { (*word).to_owned() };
    let (scene, policy) = (path("scene.yaml"), path("policy.fsm"));
    let mut all = vec!["run".to_owned(), scene, "--policy".to_owned(), policy];
    all.extend(words.iter().map(inside));
    vibrissa(&all.iter().map(String::as_str).collect::<Vec<_>>())
}

fn name_of(hello: &Value, states: &Value) -> String {
    let inner = states.as_array().unwrap().last().and_then(Value::as_u64);
    inner.map_or_else(String::new, |state| {
        hello["chart"]["states"][usize::try_from(state).unwrap()]["name"].as_str().unwrap().to_owned()
    })
}

/// The ticks that `run --ticks` writes.
fn ticks(file: &Path) -> Vec<Value> {
    fs::read_to_string(file).unwrap().lines().map(|line| serde_json::from_str(line).unwrap()).collect()
}

#[test]
fn over_a_recording_it_differs_where_a_replay_of_the_changed_policy_does() {
    let folder = recorded("live-recorded");
    let text = fs::read_to_string(folder.join("policy.fsm")).unwrap();
    // Each change, and the same change in the text.
    let (name, from, to) = ("speed", "param speed  = 30 mm/s", "param speed  = 40 mm/s");
    assert!(text.contains(from));
    let changed = folder.join("changed.fsm");
    fs::write(&changed, text.replace(from, to)).unwrap();
    let [file, policy] = [folder.join("run.mcap"), changed].map(|path| path.to_str().unwrap().to_owned());
    let oracle = vibrissa(&["replay", "--json", &file, "--policy", &policy]);
    let oracle: Value = serde_json::from_str(&stdout(&oracle)).unwrap();

    let session = Session::start(&folder, &["replay", "run.mcap", "--live"]);
    let (mut page, hello) = session.page();
    assert_eq!((&hello["command"], &hello["known_ticks"]), (&"replay".into(), &750.into()));
    page.until_status("finished");
    let ask = |tick: u64, id: u64, value: f64| json!({"type": "counterfactual", "id": id, "tick": tick, "kind": "recorded", "set": {name: value}});
    let (frames, last) = page.ask(&ask(0, 1, 0.04));
    assert_eq!((frames.len(), &last["end"]), (750, &"end of the run".into()));
    assert_eq!(last["first_difference"]["tick"], oracle["first"]["tick"], "{oracle}");
    assert_eq!(last["first_difference"]["states_differ"], false, "this policy leaves no state because of its speed");
    // A later change shows from its tick on.
    let (frames, last) = page.ask(&ask(300, 2, 0.04));
    assert_eq!((frames.len(), &frames[0]["tick"]), (450, &300.into()));
    assert_eq!(last["first_difference"]["tick"], 300);
    // No change, no difference: from any tick the copies of the loop go on as the run did.
    for (id, tick) in [(3, 0), (4, 255), (5, 256), (6, 511), (7, 749)] {
        let (frames, last) = page.ask(&ask(tick, id, 0.03));
        assert_eq!((frames.len() as u64, &last["first_difference"]), (750 - tick, &Value::Null), "{tick}");
    }
    page.send(&ask(750, 8, 0.04));
    let (error, _) = page.until(|message| message["type"] == "error");
    assert_eq!(error["id"], 8);
    page.send(&json!({"type": "counterfactual", "id": 9, "tick": 0, "kind": "closed_loop", "set": {}}));
    let (error, _) = page.until(|message| message["type"] == "error");
    assert!(error["message"].as_str().unwrap().contains("cannot be simulated again"), "{error}");
}

/// A policy with constants in its guards.
const THRESHOLDS: &str = "machine late\nwhisker r0\ninitial Go\n\
    state Go { steer body along direction(body.yaw) at 30 mm/s turning 0 deg/s  when time > 2 s and not body.blocked -> Turn }\n\
    state Turn { steer body along direction(body.yaw) at 30 mm/s turning 5 deg/s  after 3 s -> Back }\n\
    state Back { steer body along direction(body.yaw) at 20 mm/s turning -5 deg/s  when time > 6 s for 1 s -> Go }\n";

#[test]
fn a_changed_threshold_acts_as_the_changed_text() {
    let folder = recorded("live-threshold");
    fs::write(folder.join("policy.fsm"), THRESHOLDS).unwrap();
    run(&folder, &["--record", "run.mcap"]);
    let session = Session::start(&folder, &["replay", "run.mcap", "--live"]);
    let (mut page, hello) = session.page();
    page.until_status("finished");
    let changes = [
        ("time > 2 s", "time > 4 s", 4.0),
        ("after 3 s", "after 2 s", 2.0),
        ("for 1 s", "for 500 ms", 0.5),
        ("time > 6 s", "time > 5.5 s", 5.5),
    ];
    let thresholds: Vec<&Value> =
        hello["parameters"].as_array().unwrap().iter().filter(|parameter| !parameter["guard"].is_null()).collect();
    assert_eq!(thresholds.len(), changes.len(), "{thresholds:?}");
    for (id, (from, to, value)) in (0..).zip(changes) {
        let changed = folder.join("changed.fsm");
        fs::write(&changed, THRESHOLDS.replace(from, to)).unwrap();
        let file = folder.join("run.mcap");
        let oracle = vibrissa(&["replay", "--json", file.to_str().unwrap(), "--policy", changed.to_str().unwrap()]);
        let oracle: Value = serde_json::from_str(&stdout(&oracle)).unwrap();
        let is_it = |parameter: &&&Value| parameter["meaning"].as_str().unwrap().ends_with(from);
        let name = thresholds.iter().find(is_it).unwrap()["name"].as_str().unwrap();
        let (_, last) =
            page.ask(&json!({"type": "counterfactual", "id": id, "tick": 0, "kind": "recorded", "set": {name: value}}));
        assert!(last["first_difference"]["tick"].is_u64(), "{last}");
        assert_eq!(last["first_difference"]["tick"], oracle["first"]["tick"], "{to}: {oracle}");
        assert_eq!(last["first_difference"]["states_differ"], true, "{to}");
        // A change at a later tick before the difference leads to the same one.
        let (_, later) = page.ask(
            &json!({"type": "counterfactual", "id": id + 100, "tick": 20, "kind": "recorded", "set": {name: value}}),
        );
        assert_eq!(later["first_difference"], last["first_difference"], "{to}");
    }
}

#[test]
fn in_closed_loop_it_is_a_run_of_the_changed_policy() {
    let folder = recorded("live-closed");
    run(&folder, &["--set", "speed=40 mm/s", "--ticks", "changed.jsonl"]);
    run(&folder, &["--ticks", "same.jsonl"]);
    let session = Session::start(&folder, &["replay", "run.mcap", "--live", "--scenario", "scene.yaml"]);
    let (mut page, hello) = session.page();
    assert!(hello["scene"].is_array() && hello["capabilities"]["closed_loop"] == true, "{}", hello["capabilities"]);
    page.until_status("finished");
    let ask = |tick: u64, id: u64, value: f64| json!({"type": "counterfactual", "id": id, "tick": tick, "kind": "closed_loop", "set": {"speed": value}});
    let is_tick = |frame: &Value, tick: &Value| {
        let pose = frame["pose"].as_array().unwrap();
        let position = tick["position_m"].as_array().unwrap();
        (pose[0] == position[0] && pose[1] == position[1] && pose[2] == tick["heading_rad"])
            && name_of(&hello, &frame["states"]) == tick["state"].as_str().unwrap_or("")
    };
    for (id, value, file) in [(1, 0.04, "changed.jsonl"), (2, 0.03, "same.jsonl")] {
        let (frames, _) = page.ask(&ask(0, id, value));
        let ticks = ticks(&folder.join(file));
        assert_eq!(frames.len(), ticks.len());
        let different = frames.iter().zip(&ticks).position(|(frame, tick)| !is_tick(frame, tick));
        assert_eq!(different, None, "{file}");
    }
    // From a later tick on, only what follows may differ.
    let (frames, last) = page.ask(&ask(400, 3, 0.04));
    let ticks = ticks(&folder.join("same.jsonl"));
    assert!(is_tick(&frames[0], &ticks[400]) && !is_tick(&frames[30], &ticks[430]));
    assert_eq!((&last["first_difference"]["tick"], &last["end"]), (&400.into(), &"completed".into()));
}
