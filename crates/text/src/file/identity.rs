//! The identity of a file under all its names.

use std::fs::{File, Metadata};
use std::io::{Error, ErrorKind, Result};
use std::path::{Path, PathBuf};

/// The maximum number of links in a chain.
const MAX_LINKS: usize = 40;

/// A property that no two files share.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub(super) enum Identity {
    /// The device and the number of the inode. They are the same under all names, including hard links.
    Inode(u64, u64),
    /// The path without links. The file need not exist.
    Path(PathBuf),
}

impl Identity {
    /// The identities of the file at a path. There are none if its folder does not exist.
    pub(super) fn of(path: &Path) -> impl Iterator<Item = Self> {
        let inode = path.metadata().ok().and_then(|about| Self::inode(&about));
        inode.into_iter().chain(resolve_links(path).ok().map(Self::Path))
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

/// True if an open file is still the one at a path. Another file may have replaced it.
#[must_use]
pub fn is_at(file: &File, path: &Path) -> bool {
    let inode = |about: Result<Metadata>| about.ok().and_then(|about| Identity::inode(&about));
    !cfg!(unix) || inode(file.metadata()) == inode(path.metadata())
}

/// The path with all links resolved. The file itself need not exist, because a link may lead to a file that is not yet
/// written.
pub(super) fn resolve_links(path: &Path) -> Result<PathBuf> {
    match path.canonicalize() {
        Err(cause) if cause.kind() == ErrorKind::NotFound => {}
        found => return found,
    }
    let mut path = path.to_owned();
    for _ in 0..MAX_LINKS {
        let Ok(target) = path.read_link() else {
            let name = path.file_name().ok_or(ErrorKind::InvalidInput)?;
            return Ok(folder(&path).canonicalize()?.join(name));
        };
        path = folder(&path).join(target);
    }
    Err(Error::other("too many links lead on from each other"))
}

/// The folder of a file.
pub(super) fn folder(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if folder != Path::new("") => folder,
        _ => Path::new("."),
    }
}

#[cfg(all(test, unix))]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]
    use super::*;

    /// The oracle is the system: it follows the links when the file is created.
    #[test]
    fn the_place_of_a_file_is_known_before_the_file_is_there() {
        use std::os::unix::fs::symlink;
        let folder = tempfile::tempdir().unwrap();
        let root = folder.path();
        std::fs::create_dir_all(root.join("a/b")).unwrap();
        symlink("a/b", root.join("to_b")).unwrap();
        // Each leads to the previous one: in the same folder, from another folder, absolutely, through a link to a
        // folder.
        symlink("../new", root.join("a/one")).unwrap();
        symlink("../one", root.join("a/b/two")).unwrap();
        symlink(root.join("to_b/two"), root.join("three")).unwrap();
        symlink("./a/../three", root.join("four")).unwrap();
        for path in ["new", "a/one", "to_b/two", "three", "four", "to_b/../one", "a/b/new"] {
            let path = root.join(path);
            let before = resolve_links(&path).unwrap();
            assert!(!path.exists(), "{}", path.display());
            std::fs::write(&path, "").unwrap();
            assert_eq!(before, path.canonicalize().unwrap());
            assert!(Identity::of(&path).any(|identity| identity == Identity::Path(before.clone())));
            std::fs::remove_file(before).unwrap();
        }
        symlink("circle", root.join("circle")).unwrap();
        assert!(resolve_links(&root.join("circle")).is_err() && resolve_links(&root.join("nowhere/new")).is_err());
    }
}
