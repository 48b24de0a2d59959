//! What makes two paths lead to one file.

use std::fs::{File, Metadata};
use std::io::{Error, ErrorKind, Result};
use std::path::{Path, PathBuf};

/// The most links that lead on from each other.
const LINKS: usize = 40;

/// A property that no two files share.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub(super) enum Identity {
    /// The device and the number of the inode: they are the same under all names, hard links included.
    Inode(u64, u64),
    /// The path without links, of a file that may not exist yet.
    Place(PathBuf),
}

impl Identity {
    /// The identities of the file at a path. There are none if nothing can be there, because a folder is missing.
    pub(super) fn of(path: &Path) -> impl Iterator<Item = Self> {
        let inode = path.metadata().ok().and_then(|about| Self::inode(&about));
        inode.into_iter().chain(place(path).ok().map(Self::Place))
    }

    #[cfg(unix)]
    #[expect(clippy::unnecessary_wraps, reason = "elsewhere there is none")]
    pub(super) fn inode(about: &Metadata) -> Option<Self> {
        use std::os::unix::fs::MetadataExt;
        Some(Self::Inode(about.dev(), about.ino()))
    }

    #[cfg(not(unix))]
    pub(super) fn inode(_: &Metadata) -> Option<Self> {
        None
    }
}

/// Whether a file that is open is still the one at a path: it may have been replaced since.
#[must_use]
pub fn is_at(file: &File, path: &Path) -> bool {
    let inode = |about: Result<Metadata>| about.ok().and_then(|about| Identity::inode(&about));
    !cfg!(unix) || inode(file.metadata()) == inode(path.metadata())
}

/// Where a path leads when all links are followed. The file itself need not exist, so that a link may lead to one that is yet to be written.
pub(super) fn place(path: &Path) -> Result<PathBuf> {
    match path.canonicalize() {
        Err(cause) if cause.kind() == ErrorKind::NotFound => {}
        found => return found,
    }
    let mut path = path.to_owned();
    for _ in 0..LINKS {
        let Ok(target) = path.read_link() else {
            let name = path.file_name().ok_or(ErrorKind::InvalidInput)?;
            return Ok(folder(&path).canonicalize()?.join(name));
        };
        path = folder(&path).join(target);
    }
    Err(Error::other("too many links lead on from each other"))
}

/// The folder that a file is in.
pub(super) fn folder(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if folder != Path::new("") => folder,
        _ => Path::new("."),
    }
}
