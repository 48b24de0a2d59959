//! Errors of a store.

use std::io;
use std::path::PathBuf;
use vibrissa_text::system::in_words;

use super::frame::FrameError;
use super::machine_hash::MachineHash;
use super::state::Rejection;
use super::state_file::StateFileError;
use super::verified_machine::Refusal;

/// An error of a store.
#[derive(Debug, thiserror::Error)]
pub enum StoreError {
    /// The store cannot be opened.
    #[error(
        "cannot open the store {}: {words}; create this directory and give it to the user of this program, or name another",
        path.display(), words = in_words(cause))]
    Open {
        /// The store.
        path: PathBuf,
        /// The cause.
        cause: io::Error,
    },
    /// A file cannot be read.
    #[error("cannot read {}: {words}; make it a regular file that the user of this program can read", path.display(), words = in_words(cause))]
    Read {
        /// The file.
        path: PathBuf,
        /// The cause.
        cause: io::Error,
    },
    /// A file cannot be written.
    #[error("cannot write {}: {words}; check the owner of the store and the free space of the disk", path.display(), words = in_words(cause))]
    Write {
        /// The file or folder.
        path: PathBuf,
        /// The cause.
        cause: io::Error,
    },
    /// Another program keeps the store locked.
    #[error("another program is changing the store {}; try again when it has ended", path.display())]
    Busy {
        /// The store.
        path: PathBuf,
    },
    /// The state cannot be used.
    #[error(
        "the state of the store, {}, cannot be used: {cause}; use the program that wrote it, or move the file away and push \
         the machine again", path.display()
    )]
    State {
        /// The file.
        path: PathBuf,
        /// The cause.
        cause: StateFileError,
    },
    /// A machine of the store cannot be run.
    #[error("the machine {hash} cannot be used: {cause}; push it or another machine again")]
    Unusable {
        /// The machine.
        hash: MachineHash,
        /// The cause.
        cause: String,
    },
    /// There is no machine to run.
    #[error(
        "the store has no machine to run{}; sign a machine with `minisign -Sm FILE` and push it with `vibrissa push HOST FILE`",
        after(rejected.as_ref())
    )]
    NoMachine {
        /// The last machine that was given up.
        rejected: Option<Rejection>,
    },
    /// A machine is older than the good one.
    #[error(
        "the machine has {}, and the robot has had a good one with the counter {least}; sign the machine again with a larger \
         one, such as `-t 'counter:{}'`", counter(*found), least.saturating_add(1)
    )]
    RolledBack {
        /// The counter of the machine.
        found: Option<u64>,
        /// The least counter.
        least: u64,
    },
    /// A machine that is no longer tentative was to be marked good or given up.
    #[error(
        "the machine {hash} is not the tentative one, because another was pushed or it was given up; push it again to try it"
    )]
    NotTentative {
        /// The machine.
        hash: MachineHash,
    },
}

/// An error of receiving a push. After [`ReceiveError::Store`], the store has its old state or the new one. After the other
/// errors it has its old state.
#[derive(Debug, thiserror::Error)]
pub enum ReceiveError {
    /// The stream is not one complete frame.
    #[error(transparent)]
    Frame(#[from] FrameError),
    /// The machine is refused.
    #[error(transparent)]
    Refused(#[from] Refusal),
    /// The store cannot be read or written.
    #[error(transparent)]
    Store(#[from] StoreError),
}

fn after(rejected: Option<&Rejection>) -> String {
    rejected.map(|rejected| format!(", the last one was given up ({rejected})")).unwrap_or_default()
}

fn counter(found: Option<u64>) -> String {
    found.map_or_else(|| "no counter".to_owned(), |counter| format!("the counter {counter}"))
}
