//! The file operations of a store.

use std::fmt::Debug;
use std::fs::File;
use std::io::{ErrorKind, Result};

/// A folder of a store.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Folder {
    /// The store itself.
    Root,
    /// The folder `machines`.
    Machines,
}

impl Folder {
    /// Its path in the store.
    pub(super) fn path(self) -> &'static str {
        match self {
            Self::Root => "",
            Self::Machines => "machines",
        }
    }
}

/// The lock of a store. It is released when it is dropped.
#[derive(Debug)]
pub(super) struct Lock(#[expect(dead_code, reason = "closing the file releases the lock")] pub(super) Option<File>);

/// The file operations of a store. None of them follows a symbolic link of that name.
pub(super) trait Disk: Debug + Send + Sync {
    /// Locks the store for changes. Fails with [`ErrorKind::WouldBlock`] if another program keeps it locked.
    fn lock(&self) -> Result<Lock>;
    /// Reads a regular file of at most `limit` bytes.
    fn read(&self, folder: Folder, name: &str, limit: usize) -> Result<Vec<u8>>;
    /// Names of all files that are valid UTF-8.
    fn names(&self, folder: Folder) -> Result<Vec<String>>;
    /// Creates a file that does not exist yet, writes its content and synchronises it.
    fn create(&self, folder: Folder, name: &str, content: &[u8]) -> Result<()>;
    /// Gives a file a new name. A file of that name is replaced.
    fn rename(&self, folder: Folder, from: &str, to: &str) -> Result<()>;
    /// Removes a file.
    fn remove(&self, folder: Folder, name: &str) -> Result<()>;
    /// Synchronises the names of a folder.
    fn sync(&self, folder: Folder) -> Result<()>;
}

/// Prefix of temporary files. The name of the file follows, and then [`TEMPORARY_SUFFIX`].
const TEMPORARY_PREFIX: &str = ".vibrissa-";
const TEMPORARY_SUFFIX: &str = ".tmp";

/// True if a file of this name is an unfinished one of [`replace`]. It remains only after a kill or a loss of power.
pub(super) fn is_temporary(name: &str) -> bool {
    name.starts_with(TEMPORARY_PREFIX) && name.ends_with(TEMPORARY_SUFFIX)
}

/// Replaces the content of a file, or creates it. The name is durable only after [`Disk::sync`].
///
/// The caller has the lock, so no other program uses the temporary file.
pub(super) fn replace(disk: &dyn Disk, folder: Folder, name: &str, content: &[u8]) -> Result<()> {
    let temporary = format!("{TEMPORARY_PREFIX}{name}{TEMPORARY_SUFFIX}");
    match disk.remove(folder, &temporary) {
        Err(cause) if cause.kind() != ErrorKind::NotFound => return Err(cause),
        _ => {}
    }
    disk.create(folder, &temporary, content)?;
    disk.rename(folder, &temporary, name)
}
