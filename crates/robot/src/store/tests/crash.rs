//! A kill or a loss of power at any time leaves the old state or the new one.

use std::path::Path;

use crate::store::local_disk::LocalDisk;
use crate::store::{Role, Store, StoreError, VerifiedMachine};

use super::fixture::{files, hash, make_good, receive, store, verified};
use super::interrupted_disk::{InterruptedDisk, Kill};
use super::simulated_disk::SimulatedDisk;

/// A change of a store.
type Change = fn(&Store, &VerifiedMachine) -> Result<(), StoreError>;

/// All changes. The machine 2 is tentative, if any is.
const CHANGES: [Change; 5] = [
    |store, pushed| store.take(pushed).map(drop),
    |store, _| store.begin_run().map(drop),
    |store, _| store.undo_start(hash(2)),
    |store, _| store.mark_good(hash(2)),
    |store, _| store.reject(hash(2), "no contact for 10 s"),
];

/// An empty disk. One with a good machine and a tentative one that replaces another. The same, with a start of the
/// tentative one.
fn disks() -> [SimulatedDisk; 3] {
    let full = SimulatedDisk::default();
    make_good(&full.store(), 1);
    receive(&full.store(), 4);
    receive(&full.store(), 2);
    full.lose_power(0);
    let started = full.copy();
    started.store().begin_run().unwrap();
    started.lose_power(0);
    [SimulatedDisk::default(), full, started]
}

fn kills() -> impl Iterator<Item = Kill> {
    (0..).flat_map(|after| [0, 2, 4].map(|quarters| Kill { after, quarters }))
}

fn loads_what_its_state_names(store: &Store) {
    for hash in store.status().unwrap().kept() {
        store.load(hash, Role::Good).unwrap();
    }
    match (store.status().unwrap().current(), store.current()) {
        (Some((hash, role)), Ok(machine)) => assert_eq!((machine.hash, machine.role), (hash, role)),
        (None, Err(StoreError::NoMachine { .. })) => {}
        (state, current) => panic!("{state:?}, but {current:?}"),
    }
}

#[test]
fn a_loss_of_power_leaves_the_old_state_or_the_new_one() {
    let pushed = verified(3);
    let mut losses = 0;
    for before in disks() {
        for change in CHANGES {
            let old = before.store().status().unwrap();
            let new = before.copy();
            let succeeds = change(&new.store(), &pushed).is_ok();
            let new = new.store().status().unwrap();
            for kill in kills() {
                let killed = before.copy();
                let disk = InterruptedDisk::new(killed.clone(), kill);
                let done = change(&Store::on(Path::new("store"), Box::new(disk.clone())), &pushed);
                for survivors in 0..1 << killed.pending() {
                    let after = killed.copy();
                    after.lose_power(survivors);
                    let store = after.store();
                    let state = store.status().unwrap();
                    // What was confirmed survives.
                    assert!(state == new || state == old && done.is_err(), "{kill:?}, survivors {survivors:b}");
                    loads_what_its_state_names(&store);
                    // The leftovers hinder nothing.
                    store.take(&pushed).unwrap();
                    assert_eq!(store.current().unwrap().hash, pushed.hash());
                    losses += 1;
                }
                if !disk.was_killed() {
                    assert_eq!(done.is_ok(), succeeds);
                    break;
                }
            }
        }
    }
    assert!(losses > 300, "{losses}");
}

#[test]
fn a_kill_leaves_the_old_state_or_the_new_one_on_a_real_disk() {
    let pushed = verified(3);
    for kill in kills() {
        let (folder, store) = store();
        make_good(&store, 1);
        let old = store.status().unwrap();
        let disk = InterruptedDisk::new(LocalDisk::open(folder.path()).unwrap(), kill);
        let done = Store::on(folder.path(), Box::new(disk.clone())).take(&pushed);
        let store = Store::open(folder.path()).unwrap();
        let state = store.status().unwrap();
        assert!(if state == old { done.is_err() } else { state.current().unwrap().0 == pushed.hash() }, "{kill:?}");
        loads_what_its_state_names(&store);
        store.take(&pushed).unwrap();
        assert_eq!(store.current().unwrap().hash, pushed.hash());
        // No unfinished file remains.
        let names = |path: &Path| files(path).into_iter().map(|(name, _)| name).collect::<Vec<_>>();
        assert_eq!(names(folder.path()), ["lock", "machines", "state.json"]);
        assert_eq!(names(&folder.path().join("machines")).len(), 4);
        if !disk.was_killed() {
            return;
        }
    }
}
