//! Signed machines and stores for the tests.

use std::fs;
use std::path::{Path, PathBuf};

use tempfile::TempDir;

use crate::store::{Keys, MachineHash, SignedMachine, Store, VerifiedMachine};

/// The number of signed machines.
pub(super) const MACHINES: usize = 8;

/// The path of a fixture.
pub(super) fn path(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures/store").join(name)
}

/// The signed machine of a number, from 1.
pub(super) fn machine(number: usize) -> SignedMachine {
    SignedMachine::from_file(&path(&format!("{number}.machine"))).unwrap()
}

pub(super) fn hash(number: usize) -> MachineHash {
    machine(number).hash()
}

/// The trusted key.
pub(super) fn keys() -> Keys {
    Keys::from_file(&path("test.pub")).unwrap()
}

pub(super) fn verified(number: usize) -> VerifiedMachine {
    keys().verify(machine(number)).unwrap()
}

pub(super) fn frame(machine: &SignedMachine) -> Vec<u8> {
    let mut bytes = Vec::new();
    machine.write_frame(&mut bytes).unwrap();
    bytes
}

/// An empty store in a temporary directory.
pub(super) fn store() -> (TempDir, Store) {
    let folder = tempfile::tempdir().unwrap();
    let store = Store::open(folder.path()).unwrap();
    (folder, store)
}

/// Pushes the machine of a number.
pub(super) fn receive(store: &Store, number: usize) {
    store.receive(&frame(&machine(number))[..], &keys()).unwrap();
}

/// Pushes the machine of a number, starts it and marks it good.
pub(super) fn make_good(store: &Store, number: usize) {
    receive(store, number);
    assert_eq!(store.begin_run().unwrap().hash, hash(number));
    store.mark_good(hash(number)).unwrap();
}

/// All files of a folder with their contents, in order. Folders have no content.
pub(super) fn files(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap());
    let mut files: Vec<_> = entries
        .map(|entry| (entry.file_name().into_string().unwrap(), fs::read(entry.path()).unwrap_or_default()))
        .collect();
    files.sort();
    files
}
