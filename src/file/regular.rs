//! Regular files, opened.

use std::fs::{File, FileType, OpenOptions};
use std::io::{Error, ErrorKind, Read, Result};
use std::path::Path;

/// What a path leads to that is no regular file.
#[derive(Debug, Clone, Copy, thiserror::Error)]
#[error("it is {}, not a regular file; {}", .0.0, .0.1)]
struct NotRegular((&'static str, &'static str));

/// Opens a regular file for reading.
///
/// # Errors
/// It cannot be opened, or it is something else: a pipe may never begin or never end, a device neither.
pub fn open(path: &Path) -> Result<File> {
    check(path.metadata()?.file_type())?;
    File::open(path)
}

/// Opens a regular file for reading and appending; an empty one is made where there is none.
///
/// # Errors
/// As of [`open`], and when it cannot be written.
pub fn append(path: &Path) -> Result<File> {
    match path.metadata() {
        Ok(about) => check(about.file_type())?,
        Err(cause) if cause.kind() == ErrorKind::NotFound => {}
        Err(cause) => return Err(cause),
    }
    OpenOptions::new().read(true).append(true).create(true).open(path)
}

/// The bytes of a regular file, but no more than show that there are more than `limit`.
///
/// # Errors
/// As of [`open`], and when it cannot be read.
pub fn read(path: &Path, limit: usize) -> Result<Vec<u8>> {
    read_at_most(open(path)?, limit)
}

/// The same of what is open.
///
/// # Errors
/// It cannot be read.
pub fn read_at_most(from: impl Read, limit: usize) -> Result<Vec<u8>> {
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
            return ("a pipe", "save what the pipe gives in a file, and give that");
        }
        if kind.is_socket() {
            return ("a socket", "give a file");
        }
    }
    ("a device", "give a file")
}
