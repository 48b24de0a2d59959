//! Files outside of a store.
#![expect(clippy::disallowed_methods, reason = "this module opens files for reading")]

use std::fs::File;
use std::io::{Error, ErrorKind, Read, Result};
use std::path::Path;

/// Reads a regular file of at most `limit` bytes.
///
/// # Errors
/// The file cannot be read, is larger, or is not regular. Reading a pipe or a device may wait for ever or never end.
pub(super) fn read(path: &Path, limit: usize) -> Result<Vec<u8>> {
    if !path.metadata()?.is_file() {
        return Err(Error::new(ErrorKind::InvalidInput, "it is not a regular file"));
    }
    read_at_most(File::open(path)?, limit)
}

/// Reads an open file of at most `limit` bytes.
///
/// # Errors
/// The file cannot be read or is larger.
pub(super) fn read_at_most(from: impl Read, limit: usize) -> Result<Vec<u8>> {
    let mut bytes = Vec::new();
    from.take(limit as u64 + 1).read_to_end(&mut bytes)?;
    if bytes.len() > limit {
        return Err(Error::new(ErrorKind::FileTooLarge, format!("it is larger than {limit} bytes")));
    }
    Ok(bytes)
}
