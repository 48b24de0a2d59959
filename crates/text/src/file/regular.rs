//! Regular files, opened.

use std::fs::{File, FileType, OpenOptions};
use std::io::{Error, ErrorKind, Read, Result};
use std::path::Path;

/// The error for a path that leads to something other than a regular file.
#[derive(Debug, Clone, Copy, thiserror::Error)]
#[error("it is {}, not a regular file; {}", .0.0, .0.1)]
struct NotRegular((&'static str, &'static str));

/// Opens a regular file for reading.
///
/// # Errors
/// The file cannot be opened or is not regular. Reading a pipe or a device may wait for ever or never end.
pub fn open(path: &Path) -> Result<File> {
    check(path.metadata()?.file_type())?;
    File::open(path)
}

/// Opens a regular file for reading and appending. Creates an empty one if there is none.
///
/// # Errors
/// Those of [`open`], or the file cannot be written.
pub fn append(path: &Path) -> Result<File> {
    match path.metadata() {
        Ok(about) => check(about.file_type())?,
        Err(cause) if cause.kind() == ErrorKind::NotFound => {}
        Err(cause) => return Err(cause),
    }
    OpenOptions::new().read(true).append(true).create(true).open(path)
}

/// Reads a regular file, at most `limit` bytes and one more. A longer result shows that the file exceeds the limit.
///
/// # Errors
/// Those of [`open`], or the file cannot be read.
pub fn read(path: &Path, limit: usize) -> Result<Vec<u8>> {
    read_at_most(open(path)?, limit)
}

/// Reads an open file, at most `limit` bytes and one more.
///
/// # Errors
/// The file cannot be read.
pub(super) fn read_at_most(from: impl Read, limit: usize) -> Result<Vec<u8>> {
    let mut bytes = Vec::new();
    from.take(limit as u64 + 1).read_to_end(&mut bytes)?;
    Ok(bytes)
}

fn check(kind: FileType) -> Result<()> {
    if kind.is_file() { Ok(()) } else { Err(Error::new(ErrorKind::InvalidInput, NotRegular(kind_and_advice(kind)))) }
}

fn kind_and_advice(kind: FileType) -> (&'static str, &'static str) {
    if kind.is_dir() {
        return ("a directory", "give a file in it");
    }
    #[cfg(unix)]
    {
        use std::os::unix::fs::FileTypeExt;
        if kind.is_fifo() {
            return ("a pipe", "save the output of the pipe in a file, and give that file");
        }
        if kind.is_socket() {
            return ("a socket", "give a file");
        }
    }
    ("a device", "give a file")
}
