//! What each tick of a run shows on the page.

use std::fs;
use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use super::session::{SCENE, Session, Viewer};
use crate::command::program::{ROOT, directory, stdout, vibrissa};

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
