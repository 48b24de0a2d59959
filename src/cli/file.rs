//! Writing files.

use std::fs;
use std::path::Path;

use super::exit::Failure;
use super::job::extended;

/// Writes a file as a whole: whoever looks finds the old one or the new one, also if the program is ended meanwhile. A link stays one, and
/// what is no file, such as a pipe, is written to.
pub(super) fn write(path: &Path, content: impl AsRef<[u8]>) -> Result<(), Failure> {
    let written = if path.metadata().is_ok_and(|about| !about.is_file()) {
        fs::write(path, content)
    } else {
        replace(&path.canonicalize().unwrap_or_else(|_| path.to_owned()), content)
    };
    written.map_err(Failure::write(path))
}

fn replace(path: &Path, content: impl AsRef<[u8]>) -> std::io::Result<()> {
    // Beside the file, because only within a file system a new name takes the place of the old one at once.
    let unfinished = extended(path, "unfinished");
    let written = fs::write(&unfinished, content).and_then(|()| fs::rename(&unfinished, path));
    if written.is_err() {
        let _ = fs::remove_file(&unfinished);
    }
    written
}

/// Whether two paths lead to the same file.
pub(super) fn is_same(one: &Path, other: &Path) -> bool {
    one.canonicalize().is_ok_and(|one| other.canonicalize().is_ok_and(|other| one == other))
}
