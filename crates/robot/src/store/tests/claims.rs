//! Machines for one robot, and machines that are older than the good one.

use std::os::unix::fs::PermissionsExt;

use super::fixture::{hash, keys, machine, make_good, path, receive, store};
use crate::store::{Claims, Keys, ReceiveError, Refusal, Role, SignedMachine, Store, StoreError};

/// The machine of a number with a trusted comment that has claims.
fn claimed(number: usize) -> SignedMachine {
    SignedMachine::from_files(&path(&format!("{number}.machine")), &path(&format!("{number}.claims.minisig"))).unwrap()
}

fn push(store: &Store, machine: &SignedMachine) -> Result<Role, ReceiveError> {
    let mut frame = Vec::new();
    machine.write_frame(&mut frame).unwrap();
    store.receive(&frame[..], &keys()).map(|answer| answer.state)
}

/// Runs the tentative machine and marks it good.
fn run_well(store: &Store) {
    let hash = store.begin_run().unwrap().hash;
    store.mark_good(hash).unwrap();
}

#[test]
fn a_machine_that_was_signed_for_another_robot_is_refused() {
    let (_folder, store) = store();
    let store = store.of_robot("array");
    let refused = push(&store, &claimed(3)).unwrap_err();
    assert!(refused.to_string().contains("for the robot `other`, and this one is `array`"), "{refused}");
    assert!(matches!(refused, ReceiveError::Refused(Refusal::OtherRobot { .. })));
    assert_eq!(push(&store, &claimed(1)).unwrap(), Role::Tentative);
    // Without a name, a machine is good for every robot, as before.
    assert_eq!(push(&store, &machine(2)).unwrap(), Role::Tentative);
    assert!(matches!(push(&store, &claimed(4)), Err(ReceiveError::Refused(Refusal::Claim { .. }))), "a damaged claim");
}

#[test]
fn a_machine_that_is_older_than_the_good_one_is_refused() {
    let (_folder, store) = store();
    push(&store, &claimed(2)).unwrap();
    // A machine that is not yet good does not bar the way back.
    push(&store, &claimed(1)).unwrap();
    push(&store, &claimed(2)).unwrap();
    run_well(&store);
    assert_eq!(store.status().unwrap().counter, Some(6));
    let refused = push(&store, &claimed(1)).unwrap_err();
    assert!(refused.to_string().contains("has the counter 5"), "{refused}");
    let refused = push(&store, &machine(3)).unwrap_err();
    assert!(refused.to_string().contains("has no counter"), "{refused}");
    assert!(matches!(refused, ReceiveError::Store(StoreError::RolledBack { found: None, least: 6 })));
    assert_eq!(store.status().unwrap().current(), Some((hash(2), Role::Good)));
    // The same one may come again, and a newer one.
    assert_eq!(push(&store, &claimed(2)).unwrap(), Role::Good);
    assert_eq!(push(&store, &claimed(3)).unwrap(), Role::Tentative);
}

#[test]
fn a_machine_is_verified_again_when_it_is_loaded() {
    let (folder, store) = store();
    make_good(&store, 1);
    receive(&store, 2);
    let trusting = |name: &str| {
        Store::open(folder.path()).unwrap().of_robot("array").trusting(Keys::from_file(&path(name)).unwrap())
    };
    assert_eq!(trusting("test.pub").current().unwrap().hash, hash(2));
    assert!(trusting("other.pub").current().unwrap_err().to_string().contains("not trusted"));
    // Somebody exchanges the signature of the tentative machine, for one of another robot.
    let exchange = |number: usize, by: &str| {
        let to = folder.path().join("machines").join(format!("{}.machine.minisig", hash(number)));
        std::fs::copy(path(by), to).unwrap();
    };
    exchange(2, "1.machine.minisig");
    assert_eq!(trusting("test.pub").begin_run().unwrap().hash, hash(1), "the good one returns");
    let reason = store.status().unwrap().rejected.unwrap().reason;
    assert!(reason.contains("the signature does not fit"), "{reason}");
    receive(&store, 3);
    exchange(3, "3.claims.minisig");
    assert_eq!(trusting("test.pub").begin_run().unwrap().hash, hash(1));
    assert!(store.status().unwrap().rejected.unwrap().reason.contains("for the robot `other`"));
}

#[test]
fn only_the_owner_of_a_store_can_lock_it() {
    let (folder, store) = store();
    let lock = folder.path().join("lock");
    // The lock of an older version.
    std::fs::write(&lock, "").unwrap();
    std::fs::set_permissions(&lock, std::fs::Permissions::from_mode(0o644)).unwrap();
    receive(&store, 1);
    assert_eq!(lock.metadata().unwrap().permissions().mode() & 0o777, 0o600);
}

#[test]
fn a_verified_machine_tells_its_claims() {
    let claims = keys().verify(claimed(1)).unwrap().claims().clone();
    assert_eq!(claims, Claims { robot: Some("array".to_owned()), counter: Some(5) });
    assert_eq!(*keys().verify(machine(1)).unwrap().claims(), Claims::default());
}
