//! Damaged, foreign and linked files.

use std::fs;
use std::os::unix::fs::symlink;
use std::path::Path;
use std::sync::Barrier;
use std::thread;

use crate::store::{MachineHash, ReceiveError, Role, StateFileError, Store, StoreError};

use super::fixture::{frame, hash, keys, machine, make_good, receive, store};

fn state_file(folder: &Path) -> std::path::PathBuf {
    folder.join("state.json")
}

fn machine_file(folder: &Path, number: usize) -> std::path::PathBuf {
    folder.join(format!("machines/{}.machine", hash(number)))
}

#[test]
fn a_damaged_state_is_an_error_that_says_what_to_do() {
    let (folder, store) = store();
    make_good(&store, 1);
    receive(&store, 2);
    let file = state_file(folder.path());
    let whole = fs::read_to_string(&file).unwrap();
    for length in 0..whole.len() {
        fs::write(&file, &whole[..length]).unwrap();
        assert!(matches!(store.status(), Err(StoreError::State { cause: StateFileError::Damaged(_), .. })), "{length}");
    }
    for error in [
        store.current().unwrap_err(),
        store.begin_run().unwrap_err(),
        store.mark_good(hash(2)).unwrap_err(),
        match store.receive(&frame(&machine(3))[..], &keys()).unwrap_err() {
            ReceiveError::Store(error) => error,
            error => panic!("{error}"),
        },
    ] {
        let message = error.to_string();
        assert!(message.contains("state.json") && message.contains("push the machine again"), "{message}");
    }
    let wrong = |text: String| {
        fs::write(&file, text).unwrap();
        match store.status().unwrap_err() {
            StoreError::State { cause, .. } => cause,
            error => panic!("{error}"),
        }
    };
    assert_eq!(wrong(whole.replace(r#""format": 1"#, r#""format": 2"#)), StateFileError::Format { found: 2 });
    let twice = whole.replace(&hash(2).to_string(), &hash(1).to_string());
    assert_eq!(wrong(twice), StateFileError::Inconsistent);
    assert!(matches!(wrong(" ".repeat(1 << 10)), StateFileError::Damaged(_)));
    fs::write(&file, " ".repeat(1 << 20)).unwrap();
    assert!(matches!(store.status(), Err(StoreError::Read { .. })));
    // The advice of the message helps.
    fs::remove_file(&file).unwrap();
    receive(&store, 1);
    assert_eq!(store.current().unwrap().hash, hash(1));
}

#[test]
fn a_damaged_tentative_machine_is_given_up_and_a_damaged_good_one_is_an_error() {
    let (folder, store) = store();
    make_good(&store, 1);
    receive(&store, 2);
    let mut bytes = machine(2).artifact().to_vec();
    bytes[100] ^= 1;
    fs::write(machine_file(folder.path(), 2), bytes).unwrap();
    assert!(matches!(store.current(), Err(StoreError::Unusable { .. })));
    assert_eq!(store.begin_run().unwrap().hash, hash(1));
    assert!(store.status().unwrap().rejected.unwrap().reason.contains("damaged"));
    // A sound machine under the name of another one is no better.
    fs::write(machine_file(folder.path(), 1), machine(2).artifact()).unwrap();
    assert!(matches!(store.begin_run(), Err(StoreError::Unusable { .. })));
    fs::remove_file(machine_file(folder.path(), 1)).unwrap();
    match store.begin_run().unwrap_err() {
        error @ StoreError::Unusable { hash: unusable, .. } => {
            assert_eq!(unusable, hash(1));
            assert!(error.to_string().contains("push it"), "{error}");
        }
        error => panic!("{error}"),
    }
    // A push repairs it.
    receive(&store, 1);
    assert_eq!(store.begin_run().unwrap().role, Role::Good);
}

#[test]
fn foreign_files_stay_and_unfinished_ones_are_removed() {
    let (folder, store) = store();
    let unknown = "0".repeat(64);
    let machines = folder.path().join("machines");
    let write = |name: &str| fs::write(machines.join(name), "x").unwrap();
    let foreign = ["README", "old.machine", ".hidden", "0123.machine", &format!("{unknown}.txt")];
    let removed = [&format!("{unknown}.machine"), &format!("{unknown}.machine.minisig"), ".vibrissa-x.tmp"];
    for name in foreign.iter().chain(&removed) {
        write(name);
    }
    fs::write(folder.path().join("notes"), "x").unwrap();
    make_good(&store, 1);
    assert!(foreign.iter().all(|name| machines.join(name).exists()) && folder.path().join("notes").exists());
    assert!(!removed.iter().any(|name| machines.join(name).exists()));
}

#[test]
fn links_in_a_store_are_replaced_or_refused_but_not_followed() {
    let (folder, store) = store();
    let outside = tempfile::tempdir().unwrap();
    let target = outside.path().join("target");
    fs::write(&target, "precious").unwrap();
    let machine = machine_file(folder.path(), 1);
    for link in [
        &machine,
        &machine.with_extension("machine.minisig"),
        &folder.path().join(format!("machines/.vibrissa-{}.machine.tmp", hash(1))),
        &folder.path().join(".vibrissa-state.json.tmp"),
    ] {
        symlink(&target, link).unwrap();
    }
    receive(&store, 1);
    assert!(machine.symlink_metadata().unwrap().is_file());
    assert_eq!(store.current().unwrap().hash, hash(1));
    // A state or a lock that is a link is refused.
    for name in ["state.json", "lock"] {
        let (folder, store) = self::store();
        symlink(&target, folder.path().join(name)).unwrap();
        assert!(store.receive(&frame(&super::fixture::machine(1))[..], &keys()).is_err(), "{name}");
    }
    assert_eq!(fs::read_to_string(&target).unwrap(), "precious");
    // So is a folder. The store itself may be behind a link.
    let linked = tempfile::tempdir().unwrap();
    symlink(outside.path(), linked.path().join("machines")).unwrap();
    let error = Store::open(linked.path()).unwrap_err();
    assert!(error.to_string().contains("symbolic link"), "{error}");
    symlink(folder.path(), outside.path().join("store")).unwrap();
    assert_eq!(Store::open(&outside.path().join("store")).unwrap().current().unwrap().hash, hash(1));
}

#[test]
fn a_store_that_is_not_there_is_an_error_that_says_what_to_do() {
    let folder = tempfile::tempdir().unwrap();
    let error = Store::open(&folder.path().join("none")).unwrap_err();
    assert!(error.to_string().contains("create this directory"), "{error}");
}

/// Without the lock, several starts would get it, because each reads the state before it writes it.
#[test]
fn of_programs_that_start_at_once_only_one_gets_the_tentative_machine() {
    const THREADS: usize = 4;
    let (folder, store) = store();
    make_good(&store, 1);
    for _ in 0..20 {
        receive(&store, 2);
        let barrier = Barrier::new(THREADS);
        let start = || {
            let store = Store::open(folder.path()).unwrap();
            barrier.wait();
            store.begin_run().unwrap().role
        };
        let roles = thread::scope(|scope| {
            let started: Vec<_> = (0..THREADS).map(|_| scope.spawn(start)).collect();
            started.into_iter().map(|thread| thread.join().unwrap()).collect::<Vec<_>>()
        });
        assert_eq!(roles.iter().filter(|role| **role == Role::Tentative).count(), 1);
    }
}

/// A state of a version that kept older machines.
#[test]
fn the_older_machines_of_a_state_are_removed() {
    let (folder, store) = store();
    make_good(&store, 1);
    let file = state_file(folder.path());
    let text = fs::read_to_string(&file).unwrap();
    let older = text.replacen("\"good\"", &format!("\"previous\": [\"{}\"], \"good\"", hash(3)), 1);
    assert_ne!(older, text);
    fs::write(&file, older).unwrap();
    fs::write(machine_file(folder.path(), 3), "x").unwrap();
    assert_eq!(store.current().unwrap().hash, hash(1));
    receive(&store, 2);
    assert!(!machine_file(folder.path(), 3).exists() && !fs::read_to_string(&file).unwrap().contains("previous"));
}

#[test]
fn the_text_of_a_hash_is_64_digits_in_lower_case() {
    let text = hash(1).to_string();
    assert_eq!(text.parse::<MachineHash>(), Ok(hash(1)));
    for wrong in
        [&text[1..], &format!("{text}0"), &format!("{text}00"), &text.to_uppercase(), &text.replacen(|_| true, "é", 2)]
    {
        assert!(wrong.parse::<MachineHash>().is_err(), "{wrong}");
    }
}
