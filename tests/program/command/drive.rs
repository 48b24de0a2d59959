//! `vibrissa drive` on a robot: it becomes the program of the robot.

use std::os::unix::fs::PermissionsExt;
use std::path::Path;
use std::process::{Command, Stdio};

use super::program::{ROOT, directory, stderr, stdout, vibrissa};

/// `vibrissa drive` with this folder as the only one for programs.
fn drive(programs: &Path) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_vibrissa"));
    command.args(["drive", "--config", "array.yaml", "--", "-a.machine"]).current_dir(ROOT).env("PATH", programs);
    command.stdout(Stdio::piped()).stderr(Stdio::piped());
    command
}

#[test]
fn without_a_scenario_the_process_becomes_the_program_of_the_robot() {
    let programs = directory("drive-robot");
    let program = programs.join("vibrissa-robot");
    // Its number is that of the process that was started, so a signal of the system reaches it.
    std::fs::write(&program, "#!/bin/sh\necho $$ \"$@\"\nexit 1\n").unwrap();
    std::fs::set_permissions(&program, std::fs::Permissions::from_mode(0o755)).unwrap();
    let child = drive(&programs).spawn().unwrap();
    let process = child.id();
    let output = child.wait_with_output().unwrap();
    assert_eq!(stdout(&output), format!("{process} drive --config array.yaml -- -a.machine\n"));
    assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
}

#[test]
fn without_the_program_of_the_robot_the_message_names_it_and_the_simulation() {
    let output = drive(&directory("drive-no-robot")).output().unwrap();
    assert_eq!((output.status.code(), stdout(&output)), (Some(2), String::new()));
    let message = stderr(&output);
    assert!(message.contains("`vibrissa-robot`") && message.contains("--emulate SCENARIO"), "{message}");
}

#[test]
fn options_of_a_simulation_are_refused_without_one() {
    for option in [&["--seed", "1"][..], &["--world", "quasistatic"], &["--json"], &["--no-prune"], &["--inject", "a"]]
    {
        let output = vibrissa(&[&["drive", "a.machine", "--config", "array.yaml"], option].concat());
        assert_eq!(output.status.code(), Some(2), "{option:?}");
        assert!(stderr(&output).contains("--emulate <SCENARIO>"), "{option:?}: {}", stderr(&output));
    }
    let neither = vibrissa(&["drive", "a.machine"]);
    assert!(neither.status.code() == Some(2) && stderr(&neither).contains("--emulate <SCENARIO>"));
}
