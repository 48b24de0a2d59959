//! The Rust files of a folder.

use std::path::{Path, PathBuf};
use std::{fs, io};

/// All Rust files below a folder with their texts, in the order of their paths. An error has the path that cannot be read.
pub(crate) fn rust_files(folder: &Path) -> Result<Vec<(PathBuf, String)>, (PathBuf, io::Error)> {
    let failed = |path: &Path| {
        let path = path.to_owned();
        |cause| (path, cause)
    };
    let entries = fs::read_dir(folder).and_then(Iterator::collect::<Result<Vec<_>, _>>);
    let mut entries = entries.map_err(failed(folder))?;
    entries.sort_by_key(fs::DirEntry::path);
    let mut found = Vec::new();
    for path in entries.iter().map(fs::DirEntry::path) {
        if path.is_dir() {
            found.extend(rust_files(&path)?);
        } else if path.extension().is_some_and(|end| end == "rs") {
            let text = fs::read_to_string(&path).map_err(failed(&path))?;
            found.push((path, text));
        }
    }
    Ok(found)
}
