//! Options of all commands that use the store.

use std::path::PathBuf;

use clap::Args;

use super::drive::Error;
use crate::store::{DEFAULT_KEYS, DEFAULT_STORE, MachineHash, Store, StoreError};

/// The store.
#[derive(Debug, Args)]
pub(super) struct StoreOptions {
    /// Directory of the store
    #[arg(long, value_name = "DIR", default_value = DEFAULT_STORE)]
    store: PathBuf,
}

/// The public keys that the robot trusts.
#[derive(Debug, Args)]
pub(super) struct KeyOptions {
    /// Directory of the trusted public keys, *.pub
    #[arg(long, value_name = "DIR", default_value = DEFAULT_KEYS)]
    pub(super) keys: PathBuf,
}

/// The tentative machine of the store.
#[derive(Debug, Args)]
pub(super) struct TentativeOptions {
    /// Hash of the tentative machine. With it, no machine that was pushed meanwhile is affected
    #[arg(value_name = "HASH")]
    hash: Option<MachineHash>,
    #[command(flatten)]
    store: StoreOptions,
}

impl StoreOptions {
    pub(super) fn open(&self) -> Result<Store, StoreError> {
        Store::open(&self.store)
    }
}

impl TentativeOptions {
    /// The store, and the hash of its tentative machine.
    pub(super) fn open(&self) -> Result<(Store, MachineHash), Error> {
        let store = self.store.open()?;
        let tentative = store.status()?.tentative.map(|tentative| tentative.hash);
        let hash = self.hash.or(tentative).ok_or("no machine is tentative, so there is nothing to decide; push one")?;
        Ok((store, hash))
    }
}
