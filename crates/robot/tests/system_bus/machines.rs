//! Stores with signed machines.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use vibrissa_robot::store::{MachineHash, SignedMachine, State, Store};

use crate::server::scratch;

/// The folder with the signed machines and the public keys.
pub(crate) fn fixtures() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures/store")
}

/// The signed machine of a number.
pub(crate) fn machine(number: usize) -> SignedMachine {
    SignedMachine::from_file(&fixtures().join(format!("{number}.machine"))).unwrap()
}

pub(crate) fn hash(number: usize) -> MachineHash {
    machine(number).hash()
}

/// An empty store.
pub(crate) fn empty_store(name: &str) -> PathBuf {
    let folder = scratch().join(format!("store-{name}"));
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

/// A store with the good machine 1 and the tentative machine 2.
pub(crate) fn store(name: &str) -> PathBuf {
    let folder = empty_store(name);
    push(&folder, 1);
    assert!(run(&folder, &["good"], &[]).status.success());
    push(&folder, 2);
    folder
}

/// Pushes the machine of a number to the program.
pub(crate) fn push(folder: &Path, number: usize) {
    let mut frame = Vec::new();
    machine(number).write_frame(&mut frame).unwrap();
    let output = run(folder, &["receive", "--keys", fixtures().to_str().unwrap()], &frame);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}

pub(crate) fn state(folder: &Path) -> State {
    Store::open(folder).unwrap().status().unwrap()
}

/// Runs a command of the program on a store, with `input` on its standard input.
pub(crate) fn run(folder: &Path, arguments: &[&str], input: &[u8]) -> Output {
    let mut child = Command::new(env!("CARGO_BIN_EXE_vibrissa-robot"))
        .args(arguments)
        .arg("--store")
        .arg(folder)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    // A program that refuses may end before it has read everything.
    let _ = child.stdin.take().unwrap().write_all(input);
    child.wait_with_output().unwrap()
}
