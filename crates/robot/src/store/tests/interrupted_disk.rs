//! A disk whose program is killed between two operations, or within one.

use std::io::{Error, Result};
use std::sync::{Arc, Mutex};

use crate::store::disk::{Disk, Folder, Lock};

/// The moment of the kill.
#[derive(Debug, Clone, Copy)]
pub(super) struct Kill {
    /// The number of changes that are done before.
    pub(super) after: usize,
    /// The part of the content that is written if the next change creates a file, in quarters.
    pub(super) quarters: usize,
}

/// A disk that does some changes and fails afterwards, like a program that is killed then.
#[derive(Debug)]
pub(super) struct InterruptedDisk<D> {
    disk: Arc<D>,
    /// `None` after the kill.
    kill: Arc<Mutex<Option<Kill>>>,
}

impl<D> Clone for InterruptedDisk<D> {
    fn clone(&self) -> Self {
        Self { disk: Arc::clone(&self.disk), kill: Arc::clone(&self.kill) }
    }
}

impl<D: Disk> InterruptedDisk<D> {
    pub(super) fn new(disk: D, kill: Kill) -> Self {
        Self { disk: Arc::new(disk), kill: Arc::new(Mutex::new(Some(kill))) }
    }

    pub(super) fn was_killed(&self) -> bool {
        self.kill.lock().unwrap().is_none()
    }

    /// Fails after the kill. `last` is done at the kill.
    fn step(&self, last: impl FnOnce(Kill)) -> Result<()> {
        let mut kill = self.kill.lock().unwrap();
        match &mut *kill {
            Some(Kill { after: after @ 1.., .. }) => {
                *after -= 1;
                return Ok(());
            }
            Some(now) => last(*now),
            None => {}
        }
        *kill = None;
        Err(Error::other("killed"))
    }
}

impl<D: Disk> Disk for InterruptedDisk<D> {
    fn lock(&self) -> Result<Lock> {
        self.disk.lock()
    }

    fn read(&self, folder: Folder, name: &str, limit: usize) -> Result<Vec<u8>> {
        self.disk.read(folder, name, limit)
    }

    fn names(&self, folder: Folder) -> Result<Vec<String>> {
        self.disk.names(folder)
    }

    fn create(&self, folder: Folder, name: &str, content: &[u8]) -> Result<()> {
        self.step(|kill| {
            let part = &content[..content.len() * kill.quarters / 4];
            self.disk.create(folder, name, part).unwrap();
        })?;
        self.disk.create(folder, name, content)
    }

    fn rename(&self, folder: Folder, from: &str, to: &str) -> Result<()> {
        self.step(|_| ())?;
        self.disk.rename(folder, from, to)
    }

    fn remove(&self, folder: Folder, name: &str) -> Result<()> {
        // Without such a file there is no change.
        self.disk.read(folder, name, usize::MAX >> 1)?;
        self.step(|_| ())?;
        self.disk.remove(folder, name)
    }

    fn sync(&self, folder: Folder) -> Result<()> {
        self.step(|_| ())?;
        self.disk.sync(folder)
    }
}
