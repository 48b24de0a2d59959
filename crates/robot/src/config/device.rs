//! Device files of buses.

use std::path::{Component, Path, PathBuf};

/// True if two paths are those of one device: they are the same path, lead to the same file, or to the same driver.
pub(super) fn are_one(first: &Path, second: &Path) -> bool {
    let is_one_file = match (first.canonicalize(), second.canonicalize()) {
        (Ok(first), Ok(second)) => {
            first == second || number(&first).is_some_and(|found| number(&second) == Some(found))
        }
        _ => false,
    };
    is_one_file || normal(first) == normal(second)
}

/// The path without `.` and `..`, for devices that this computer does not have.
fn normal(path: &Path) -> PathBuf {
    let mut normal = PathBuf::new();
    for component in path.components() {
        match component {
            Component::CurDir => {}
            Component::ParentDir => {
                normal.pop();
            }
            other => normal.push(other),
        }
    }
    normal
}

/// The number of a device. Two files of one device have the same.
#[cfg(unix)]
fn number(path: &Path) -> Option<u64> {
    use std::os::unix::fs::{FileTypeExt, MetadataExt};
    let metadata = path.metadata().ok()?;
    metadata.file_type().is_char_device().then(|| metadata.rdev())
}

#[cfg(not(unix))]
fn number(_: &Path) -> Option<u64> {
    None
}
