//! A tentative machine becomes the good one, or is given up.

use crate::store::{Role, StoreError, Tentative};

use super::fixture::{MACHINES, files, frame, hash, keys, machine, make_good, receive, store};

#[test]
fn a_tentative_machine_that_is_started_twice_is_given_up() {
    let (_folder, store) = store();
    make_good(&store, 1);
    receive(&store, 2);
    let first = store.begin_run().unwrap();
    assert_eq!((first.hash, first.role), (hash(2), Role::Tentative));
    assert_eq!(store.current().unwrap().hash, hash(2));
    // The program ends here without `mark_good` and starts again.
    let second = store.begin_run().unwrap();
    assert_eq!((second.hash, second.role), (hash(1), Role::Good));
    let rejected = store.status().unwrap().rejected.unwrap();
    assert_eq!((rejected.hash, &rejected.reason[..]), (hash(2), "it was started and not marked good"));
    assert_eq!(store.begin_run().unwrap().hash, hash(1));
}

#[test]
fn a_start_without_a_run_is_taken_back() {
    let (_folder, store) = store();
    make_good(&store, 1);
    receive(&store, 2);
    for _ in 0..3 {
        assert_eq!(store.begin_run().unwrap().hash, hash(2));
        store.undo_start(hash(2)).unwrap();
        assert_eq!(store.status().unwrap().tentative, Some(Tentative { hash: hash(2), starts: 0 }));
    }
    // Not for another machine, and not below zero.
    assert!(matches!(store.undo_start(hash(1)), Err(StoreError::NotTentative { .. })));
    store.undo_start(hash(2)).unwrap();
    assert_eq!(store.begin_run().unwrap().hash, hash(2));
    assert_eq!(store.begin_run().unwrap().hash, hash(1));
    assert!(matches!(store.undo_start(hash(2)), Err(StoreError::NotTentative { .. })));
}

#[test]
fn a_good_machine_starts_any_number_of_times() {
    let (_folder, store) = store();
    make_good(&store, 1);
    for _ in 0..5 {
        assert_eq!(store.begin_run().unwrap().hash, hash(1));
        store.mark_good(hash(1)).unwrap();
    }
}

#[test]
fn a_rejected_machine_is_replaced_by_the_good_one_and_the_reason_is_kept() {
    let (_folder, store) = store();
    make_good(&store, 1);
    receive(&store, 2);
    store.begin_run().unwrap();
    store.reject(hash(2), "whisker 3:\n\x1b[31mno reading").unwrap();
    assert_eq!(store.current().unwrap().hash, hash(1));
    assert_eq!(store.status().unwrap().rejected.unwrap().reason, "whisker 3: [31mno reading");
    // Pushed again, it gets another attempt.
    receive(&store, 2);
    let state = store.status().unwrap();
    assert_eq!((state.rejected, state.tentative), (None, Some(Tentative { hash: hash(2), starts: 0 })));
}

#[test]
fn without_a_good_machine_a_failed_one_leaves_none() {
    let (_folder, store) = store();
    assert!(matches!(store.current(), Err(StoreError::NoMachine { rejected: None })));
    assert!(matches!(store.begin_run(), Err(StoreError::NoMachine { rejected: None })));
    receive(&store, 1);
    store.begin_run().unwrap();
    let error = store.begin_run().unwrap_err();
    assert!(matches!(&error, StoreError::NoMachine { rejected: Some(rejected) } if rejected.hash == hash(1)));
    let message = error.to_string();
    assert!(message.contains("not marked good") && message.contains("`minisign -Sm FILE`"), "{message}");
    assert!(matches!(store.current(), Err(StoreError::NoMachine { .. })));
}

#[test]
fn only_the_tentative_machine_can_be_marked_good_or_given_up() {
    let (_folder, store) = store();
    make_good(&store, 1);
    receive(&store, 2);
    store.begin_run().unwrap();
    // Another machine is pushed during the run.
    receive(&store, 3);
    let before = store.status().unwrap();
    assert!(matches!(store.mark_good(hash(2)), Err(StoreError::NotTentative { .. })));
    assert!(matches!(store.reject(hash(2), "late"), Err(StoreError::NotTentative { .. })));
    assert!(matches!(store.reject(hash(1), "good"), Err(StoreError::NotTentative { .. })));
    assert_eq!(store.status().unwrap(), before);
    assert_eq!(before.current(), Some((hash(3), Role::Tentative)));
}

#[test]
fn the_good_machine_pushed_again_stays_good() {
    let (_folder, store) = store();
    make_good(&store, 1);
    receive(&store, 2);
    assert_eq!(store.receive(&frame(&machine(1))[..], &keys()).unwrap().state, Role::Good);
    assert_eq!(store.status().unwrap().current(), Some((hash(1), Role::Good)));
}

#[test]
fn only_the_good_and_the_tentative_machine_are_kept() {
    let (folder, store) = store();
    for number in 1..MACHINES {
        make_good(&store, number);
    }
    receive(&store, MACHINES);
    let mut expected: Vec<_> = (MACHINES - 1..=MACHINES)
        .flat_map(|number| ["machine", "machine.minisig"].map(|ending| format!("{}.{ending}", hash(number))))
        .collect();
    expected.sort();
    let names: Vec<_> = files(&folder.path().join("machines")).into_iter().map(|(name, _)| name).collect();
    assert_eq!(names, expected);
}
