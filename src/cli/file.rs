//! Writing files.

use std::fs;
use std::path::Path;

use super::exit::Failure;
use super::job::extended;

/// Writes a file as a whole: whoever looks finds the old one or the new one, also if the program is ended meanwhile.
pub(super) fn write(path: &Path, content: impl AsRef<[u8]>) -> Result<(), Failure> {
    // Beside the file, because only within a file system a new name takes the place of the old one at once.
    let unfinished = extended(path, "unfinished");
    let written = fs::write(&unfinished, content).and_then(|()| fs::rename(&unfinished, path));
    written.map_err(|cause| {
        let _ = fs::remove_file(&unfinished);
        Failure::write(path)(cause)
    })
}
