//! A disk that can lose its power.

use std::collections::BTreeMap;
use std::io::{ErrorKind, Result};
use std::path::Path;
use std::sync::{Arc, Mutex, MutexGuard};

use crate::store::Store;
use crate::store::disk::{Disk, Folder, Lock};

type Files = BTreeMap<(Folder, String), Vec<u8>>;

/// A disk in memory. Contents are durable at once, because [`Disk::create`] synchronises them. Names are durable only after
/// [`Disk::sync`]. Before that, each change of a name may survive a loss of power or not.
#[derive(Debug, Clone, Default)]
pub(super) struct SimulatedDisk(Arc<Mutex<Content>>);

#[derive(Debug, Clone, Default)]
struct Content {
    durable: Files,
    /// Changes of names since the last synchronisation of their folder.
    pending: Vec<(Folder, Change)>,
}

#[derive(Debug, Clone)]
enum Change {
    Create { name: String, content: Vec<u8> },
    Rename { from: String, to: String, content: Vec<u8> },
    Remove { name: String },
}

fn apply(files: &mut Files, folder: Folder, change: &Change) {
    match change.clone() {
        Change::Create { name, content } => {
            files.insert((folder, name), content);
        }
        Change::Rename { from, to, content } => {
            files.remove(&(folder, from));
            files.insert((folder, to), content);
        }
        Change::Remove { name } => {
            files.remove(&(folder, name));
        }
    }
}

impl Content {
    fn files(&self) -> Files {
        let mut files = self.durable.clone();
        self.pending.iter().for_each(|(folder, change)| apply(&mut files, *folder, change));
        files
    }
}

impl SimulatedDisk {
    /// A store on this disk, as a new process opens it.
    pub(super) fn store(&self) -> Store {
        Store::on(Path::new("store"), Box::new(self.clone()))
    }

    /// A disk with the same content, independent of this one.
    pub(super) fn copy(&self) -> Self {
        Self(Arc::new(Mutex::new(self.content().clone())))
    }

    /// The number of changes that a loss of power may undo.
    pub(super) fn pending(&self) -> usize {
        self.content().pending.len()
    }

    /// Loses power. Of the changes that are not durable, those survive whose bit in `survivors` is set.
    pub(super) fn lose_power(&self, survivors: usize) {
        let mut content = self.content();
        let pending = std::mem::take(&mut content.pending);
        for (bit, (folder, change)) in pending.iter().enumerate() {
            if survivors >> bit & 1 == 1 {
                apply(&mut content.durable, *folder, change);
            }
        }
    }

    fn content(&self) -> MutexGuard<'_, Content> {
        self.0.lock().unwrap()
    }

    fn change(&self, folder: Folder, change: Change) {
        self.content().pending.push((folder, change));
    }

    fn get(&self, folder: Folder, name: &str) -> Result<Vec<u8>> {
        let content = self.content().files().remove(&(folder, name.to_owned()));
        content.ok_or_else(|| ErrorKind::NotFound.into())
    }
}

impl Disk for SimulatedDisk {
    fn lock(&self) -> Result<Lock> {
        Ok(Lock(None))
    }

    fn read(&self, folder: Folder, name: &str, _: usize) -> Result<Vec<u8>> {
        self.get(folder, name)
    }

    fn names(&self, folder: Folder) -> Result<Vec<String>> {
        let files = self.content().files();
        Ok(files.into_keys().filter(|(inside, _)| *inside == folder).map(|(_, name)| name).collect())
    }

    fn create(&self, folder: Folder, name: &str, content: &[u8]) -> Result<()> {
        if self.get(folder, name).is_ok() {
            return Err(ErrorKind::AlreadyExists.into());
        }
        self.change(folder, Change::Create { name: name.to_owned(), content: content.to_vec() });
        Ok(())
    }

    fn rename(&self, folder: Folder, from: &str, to: &str) -> Result<()> {
        let content = self.get(folder, from)?;
        self.change(folder, Change::Rename { from: from.to_owned(), to: to.to_owned(), content });
        Ok(())
    }

    fn remove(&self, folder: Folder, name: &str) -> Result<()> {
        self.get(folder, name)?;
        self.change(folder, Change::Remove { name: name.to_owned() });
        Ok(())
    }

    fn sync(&self, folder: Folder) -> Result<()> {
        let mut content = self.content();
        let pending = std::mem::take(&mut content.pending);
        for (of, change) in pending {
            if of == folder {
                apply(&mut content.durable, folder, &change);
            } else {
                content.pending.push((of, change));
            }
        }
        Ok(())
    }
}
