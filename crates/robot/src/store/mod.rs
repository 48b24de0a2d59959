//! The store: the signed machines on a robot, and their deployment.
//!
//! A store is a directory. [`DEFAULT_STORE`] is the usual one.
//!
//! | path | content |
//! |---|---|
//! | `machines/HASH.machine` | an artifact; HASH is its SHA-256 |
//! | `machines/HASH.machine.minisig` | its signature |
//! | `state.json` | the [`State`]: the good machine, the tentative one, and the last one that was given up |
//! | `lock` | an empty file, locked while a program changes the store. Only the owner of the store can read it |
//!
//! Other files stay untouched. The public keys that a robot trusts are outside of the store, normally in [`DEFAULT_KEYS`].
//! A user who can write there or in the store decides which machines run.
//!
//! # From the developer to the robot
//!
//! 1. The developer compiles a policy and signs the machine with `minisign -Sm FILE`.
//! 2. [`push`] sends the [`SignedMachine`] to a command on the robot, normally through ssh.
//! 3. That command calls [`Store::receive`]. It verifies the signature and the machine. Then the machine is tentative.
//! 4. The control program calls [`Store::begin_run`] before each run. It runs the tentative machine, or else the good one.
//! 5. Once the run goes well, the control program calls [`Store::mark_good`]. If the machine fails, it calls
//!    [`Store::reject`]. If the machine was not executed, it calls [`Store::undo_start`].
//!
//! A tentative machine that was started and not marked good is given up at the next start. The last good machine returns.
//!
//! # Old machines and other robots
//!
//! A signature is good for every robot that trusts its key, and for ever, unless its trusted comment has [`Claims`]: the name
//! of a robot, and a counter. They are checked when a machine is received. They are checked again with its signature when it
//! is loaded, if the store has the name and the keys ([`Store::of_robot`], [`Store::trusting`]).
//!
//! # Loss of power
//!
//! After a kill or a loss of power at any time, the store has either the old state or the new one. The machines that the
//! state names are written and synchronised before the state. Files that it no longer names are removed after it.

mod answer;
mod claims;
mod disk;
mod file;
mod frame;
mod keys;
mod local_disk;
mod machine_hash;
mod process;
mod push;
mod signed_machine;
mod state;
mod state_file;
#[expect(clippy::module_inception, reason = "the module is named after its noun")]
mod store;
mod store_error;
#[cfg(test)]
mod tests;
mod text;
mod verified_machine;

pub use answer::Answer;
pub use claims::Claims;
pub use frame::{FrameError, SIGNATURE_LIMIT};
pub use keys::{DEFAULT_KEYS, Keys, KeysError};
pub use machine_hash::{MachineHash, ParseHashError};
pub use push::{PushCommand, PushError, push};
pub use signed_machine::{SignedMachine, SignedMachineError};
pub use state::{Rejection, Role, State, Tentative};
pub use state_file::StateFileError;
pub use store::{DEFAULT_STORE, Store, StoredMachine};
pub use store_error::{ReceiveError, StoreError};
pub use verified_machine::{Refusal, VerifiedMachine};
