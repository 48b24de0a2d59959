//! `vibrissa drive` on a robot: it becomes the program of the robot.

use std::os::unix::fs::PermissionsExt;
use std::path::Path;
use std::process::{Command, Output, Stdio};

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
    for option in
        [&["--seed", "1"][..], &["--simulator", "quasistatic"], &["--json"], &["--no-prune"], &["--inject", "a"]]
    {
        let output = vibrissa(&[&["drive", "a.machine", "--config", "array.yaml"], option].concat());
        assert_eq!(output.status.code(), Some(2), "{option:?}");
        assert!(stderr(&output).contains("--emulate <SCENARIO>"), "{option:?}: {}", stderr(&output));
    }
    let neither = vibrissa(&["drive", "a.machine"]);
    assert!(neither.status.code() == Some(2) && stderr(&neither).contains("--emulate <SCENARIO>"));
}

/// `vibrissa drive` of a policy in a scene of this text, with these further options, in a folder of its own.
fn emulated(name: &str, files: &[(&str, &str)], arguments: &str) -> Output {
    let folder = directory(name);
    for (file, text) in files {
        std::fs::write(folder.join(file), text).unwrap();
    }
    let folder = folder.to_str().unwrap();
    vibrissa(&arguments.replace('@', folder).split_whitespace().collect::<Vec<_>>())
}

/// A scene that ends after half a second.
const SHORT: (&str, &str) = (
    "scene.yaml",
    "name: scene\nworld: quasistatic\nobjects: [{circle: {centre: [40 cm, 40 cm], radius: 30 cm}}]\n\
     start: {position: [0 mm, 72 mm], heading: 90 deg}\nstop: {time: 0.5 s}\n",
);

#[test]
fn a_sensor_that_dies_in_contact_is_named_and_the_machine_goes_on_after_it() {
    for (kind, fault) in [("no_acknowledge", "sensor_lost"), ("stale_sensor", "sensor_stale")] {
        let inject = format!("- {{at_ms: 30000, for_ms: 300, kind: {kind}, part: 0}}\n");
        let output = emulated(
            &format!("drive-{kind}"),
            &[("faults.yaml", &inject)],
            "drive policies/vibrissa.fsm --emulate scenarios/disk.yaml --simulator quasistatic --inject @/faults.yaml --json",
        );
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        let document: serde_json::Value = serde_json::from_str(&stdout(&output)).unwrap();
        let faults = document["faults"].as_array().unwrap();
        assert_eq!((&faults[0]["kind"], &faults[0]["part"]), (&fault.into(), &0.into()), "{faults:?}");
        let time = |key: &str| faults[0][key].as_f64().unwrap();
        assert!(time("reacted_s") < 30.1 && (30.3..31.0).contains(&time("recovered_s")), "{faults:?}");
        assert!(faults.iter().all(|fault| fault["kind"] != "machine_failed"), "{faults:?}");
        assert_eq!(document["undetected"], serde_json::json!([]));
    }
}

#[test]
fn a_fault_at_which_the_policy_fails_is_not_said_to_be_without_effect() {
    let output = emulated(
        "drive-overbent",
        &[("faults.yaml", "- {at_ms: 25000, for_ms: 500, kind: overbent_whisker, part: 0}\n")],
        "drive policies/thesis.fsm --emulate scenarios/disk.yaml --simulator quasistatic --inject @/faults.yaml --json",
    );
    let message = stderr(&output);
    assert_eq!(output.status.code(), Some(1), "{message}");
    assert!(message.contains("a whisker at its limit") && !message.contains("was not detected"), "{message}");
    let document: serde_json::Value = serde_json::from_str(&stdout(&output)).unwrap();
    assert_eq!(document["undetected"], serde_json::json!([]));
}

#[test]
fn a_fault_of_the_configuration_names_its_file_with_the_line_and_not_the_scenario() {
    let array = std::fs::read_to_string(format!("{ROOT}/deploy/pi/array.yaml")).unwrap();
    for (index, (from, to, words)) in [
        ("speed: 0.1 m/s", "speed: -0.1 m/s", "`speed` cannot be -0.1 m/s; it must be from 1 mm/s to 100 m/s"),
        ("length: 75 mm", "length: 0 mm", "`length` cannot be"),
        ("address: 0x0C", "address: 0x1C", "from 0x0C to 0x1B"),
        ("device: /dev/i2c-3", "device: /dev/./i2c-1", "are one bus"),
    ]
    .into_iter()
    .enumerate()
    {
        let line = array.split_once(from).unwrap().0.matches('\n').count() + 1;
        let output = emulated(
            &format!("drive-configuration-{index}"),
            &[SHORT, ("array.yaml", &array.replacen(from, to, 1))],
            "drive policies/bang.fsm --emulate @/scene.yaml --config @/array.yaml",
        );
        let message = stderr(&output);
        assert_eq!(output.status.code(), Some(2), "{message}");
        assert!(
            message.contains(&format!("/array.yaml: line {line}, column ")) && message.contains(words),
            "{message}"
        );
        assert!(!message.contains("scene.yaml") && !message.contains("panicked"), "{message}");
    }
}

#[test]
fn an_injected_fault_that_cannot_happen_is_refused_and_one_that_hits_nothing_is_listed() {
    let drive = "drive policies/bang.fsm --emulate @/scene.yaml --inject @/faults.yaml --json";
    for (index, (inject, words)) in [
        ("- {at_ms: 200, for_ms: 300, kind: stale_sensor, part: 99}", "faults.yaml: line 1, column"),
        ("- {at_ms: 200, for_ms: 18446744073709551615, kind: no_pose}", "faults.yaml: line 1, column"),
        ("- {at_ms: 2000, for_ms: 300, kind: no_pose}", "the run ends after 0.5 s at the latest"),
    ]
    .into_iter()
    .enumerate()
    {
        let output = emulated(&format!("drive-never-{index}"), &[SHORT, ("faults.yaml", inject)], drive);
        assert_eq!(output.status.code(), Some(2), "{inject}");
        assert!(stderr(&output).contains(words), "{}", stderr(&output));
    }
    // Shorter than the timeout of poses.
    let unnoticed =
        "- {at_ms: 200, for_ms: 5, kind: no_pose}\n- {at_ms: 300, for_ms: 200, kind: stale_sensor, part: 1}\n";
    let output = emulated("drive-unnoticed", &[SHORT, ("faults.yaml", unnoticed)], drive);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let document: serde_json::Value = serde_json::from_str(&stdout(&output)).unwrap();
    assert_eq!(document["undetected"], serde_json::json!([{"kind": "pose_old", "part": 0, "at_s": 0.2}]));
    assert_eq!(document["faults"][0]["kind"], "sensor_stale");
    assert!(
        stderr(&output).contains("pose_old") && stderr(&output).contains("was not detected"),
        "{}",
        stderr(&output)
    );
}
