//! `run --view`, under a virtual X server.

use std::fs;
use std::process::Command;
use std::time::Instant;

use super::program::{ROOT, directory, stderr, stdout, vibrissa};

const SCENE: &str = "name: scene\nworld: quasistatic\nobjects: [{circle: {centre: [40 cm, 40 cm], radius: 30 cm}}]\n\
    start: {position: [0 mm, 72 mm], heading: 90 deg}\nstop: {time: 3 s}\n";

/// `vibrissa run --view` under Xvfb. `None` where there is no Xvfb, except in CI.
fn viewed(name: &str) -> Option<std::process::Output> {
    let folder = directory(name);
    fs::write(folder.join("scene.yaml"), SCENE).unwrap();
    let mut command = Command::new("xvfb-run");
    command.args(["--auto-servernum", env!("CARGO_BIN_EXE_vibrissa"), "run"]).arg(folder.join("scene.yaml"));
    command.args(["--policy", "policies/bang.fsm", "--json", "--view"]).current_dir(ROOT);
    let Ok(output) = command.output() else {
        assert!(std::env::var_os("CI").is_none_or(|ci| ci.is_empty()), "CI needs the Debian packages xvfb and xauth");
        return None;
    };
    Some(output)
}

#[test]
fn a_run_is_shown_in_real_time_and_the_window_closes_at_its_end() {
    let before = Instant::now();
    let Some(output) = viewed("view") else { return };
    assert!(matches!(output.status.code(), Some(0 | 1)), "{}", stderr(&output));
    assert!(stdout(&output).contains("\"outcome\""), "{}", stdout(&output));
    // It is never faster than real time. A slow computer may be slower.
    assert!(before.elapsed().as_secs_f64() > 2.9, "{:?}", before.elapsed());
}

#[test]
fn without_a_desktop_the_video_is_named_instead() {
    let folder = directory("view-nowhere");
    fs::write(folder.join("scene.yaml"), SCENE).unwrap();
    let mut command = Command::new(env!("CARGO_BIN_EXE_vibrissa"));
    command.arg("run").arg(folder.join("scene.yaml")).args(["--policy", "policies/bang.fsm", "--view"]);
    for variable in ["DISPLAY", "WAYLAND_DISPLAY", "WAYLAND_SOCKET"] {
        command.env_remove(variable);
    }
    let output = command.current_dir(ROOT).output().unwrap();
    assert_eq!(output.status.code(), Some(2), "{}", stderr(&output));
    for wanted in ["the window cannot be opened", "--video"] {
        assert!(stderr(&output).contains(wanted), "{wanted}: {}", stderr(&output));
    }
    assert!(stdout(&output).is_empty());
}

#[test]
fn one_run_is_shown_at_a_time() {
    let output = vibrissa(&["run", "scenarios/disk.yaml", "scenarios/box.yaml", "--view"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("give one scenario"), "{}", stderr(&output));
}
