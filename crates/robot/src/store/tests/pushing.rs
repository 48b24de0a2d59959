//! Pushing through a command.

use std::ffi::OsString;
use std::fs;
use std::time::{Duration, Instant};

use crate::store::{Answer, Keys, PushCommand, PushError, Role, SignedMachine, SignedMachineError, push};

use super::fixture::{frame, hash, machine, path};

/// A command that runs a script of the shell in place of ssh.
fn shell(script: &str) -> PushCommand {
    let arguments = ["-c", script].map(OsString::from).to_vec();
    PushCommand { program: "sh".into(), arguments, timeout: Duration::from_secs(10) }
}

fn answer(number: usize) -> String {
    Answer { hash: hash(number), state: Role::Tentative }.to_string()
}

fn error(script: &str) -> PushError {
    push(&shell(script), &machine(1)).unwrap_err()
}

#[test]
fn the_command_gets_the_frame_and_its_answer_is_returned() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("frame");
    let script = format!("echo 'Welcome to the robot'; cat > '{}'; echo '{}'", file.display(), answer(1));
    let answer = push(&shell(&script), &machine(1)).unwrap();
    assert_eq!(answer, Answer { hash: hash(1), state: Role::Tentative });
    assert_eq!(fs::read(file).unwrap(), frame(&machine(1)));
}

#[test]
fn the_text_of_a_robot_that_refuses_is_in_the_error() {
    match error("cat > /dev/null; echo 'the machine is not signed' >&2; exit 1") {
        PushError::Refused { text } => assert_eq!(text, "the machine is not signed"),
        error => panic!("{error}"),
    }
    // It may refuse before it has read everything.
    assert!(matches!(error("echo no >&2; exit 1"), PushError::Refused { .. }));
}

#[test]
fn the_exit_status_tells_a_lost_connection_from_a_missing_program() {
    assert!(matches!(error("exit 255"), PushError::Connection { .. }));
    assert!(matches!(error("kill -9 $$"), PushError::Connection { .. }));
    assert!(matches!(error("no-such-program-of-a-robot"), PushError::NoProgram { .. }));
    let command = PushCommand { program: "no-such-program-of-a-robot".into(), ..shell("") };
    assert!(matches!(push(&command, &machine(1)).unwrap_err(), PushError::Start { .. }));
}

#[test]
fn an_answer_that_does_not_fit_is_an_error() {
    assert!(matches!(error("cat > /dev/null"), PushError::Answer { .. }));
    assert!(matches!(error("cat > /dev/null; echo ok"), PushError::Answer { .. }));
    // The exit status counts, whatever the answer says.
    assert!(matches!(error(&format!("echo '{}'; exit 3", answer(1))), PushError::Refused { .. }));
    assert!(matches!(error(&format!("cat > /dev/null; echo '{}'", answer(2))), PushError::OtherMachine { .. }));
}

#[test]
fn a_robot_that_does_not_answer_is_left_after_the_timeout() {
    let start = Instant::now();
    let command = PushCommand { timeout: Duration::from_millis(200), ..shell("exec sleep 60") };
    assert!(matches!(push(&command, &machine(1)).unwrap_err(), PushError::Timeout { .. }));
    assert!(start.elapsed() < Duration::from_secs(10));
}

/// Connections that ssh shares leave a background process that keeps the streams open.
#[test]
fn a_background_process_does_not_hold_up_the_answer() {
    let start = Instant::now();
    let script = format!("cat > /dev/null; sleep 20 & echo '{}'", answer(1));
    assert_eq!(push(&shell(&script), &machine(1)).unwrap().hash, hash(1));
    assert!(start.elapsed() < Duration::from_secs(10));
}

#[test]
fn a_flood_of_text_is_bounded() {
    match error("cat > /dev/null; head -c 3000000 /dev/zero | tr '\\0' x >&2; echo the end >&2; exit 1") {
        PushError::Refused { text } => assert!(text.ends_with("the end") && text.chars().count() <= 1000),
        error => panic!("{error}"),
    }
}

#[test]
fn a_host_is_never_an_option_of_ssh() {
    let arguments = PushCommand::ssh("-oProxyCommand=date").arguments;
    let end = arguments.iter().position(|argument| argument == "--").unwrap();
    assert_eq!(arguments[end + 1], "-oProxyCommand=date");
}

#[test]
fn a_machine_without_a_signature_file_names_the_command_that_signs_it() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("thesis.machine");
    assert!(matches!(SignedMachine::from_file(&file), Err(SignedMachineError::Machine { .. })));
    fs::copy(path("1.machine"), &file).unwrap();
    let error = SignedMachine::from_file(&file).unwrap_err();
    assert!(matches!(error, SignedMachineError::Unsigned { .. }));
    assert!(error.to_string().ends_with(&format!("run `minisign -Sm {}`", file.display())), "{error}");
    fs::write(folder.path().join("thesis.machine.minisig"), [0xff; 100]).unwrap();
    assert!(matches!(SignedMachine::from_file(&file), Err(SignedMachineError::Signature { .. })));
    fs::copy(path("1.machine.minisig"), folder.path().join("thesis.machine.minisig")).unwrap();
    assert_eq!(SignedMachine::from_file(&file).unwrap(), machine(1));
}

#[test]
fn a_public_key_must_be_one() {
    assert!(Keys::from_file(&path("test.pub")).is_ok());
    assert!(Keys::from_file(&path("1.machine")).is_err());
    assert!(Keys::from_file(&path("none.pub")).is_err());
    assert!(Keys::from_file(&path("")).is_err());
}
