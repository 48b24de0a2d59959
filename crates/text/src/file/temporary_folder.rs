//! A folder for files that nobody needs afterwards.

use std::io::Result;
use std::path::Path;

use tempfile::TempDir;

use super::replace::PREFIX;

/// A folder among the system's temporary files. It is removed with its content when it is dropped, and remains only if the
/// program is ended before.
#[derive(Debug)]
pub struct TemporaryFolder(TempDir);

impl TemporaryFolder {
    /// A new, empty folder that only this user can read.
    ///
    /// # Errors
    /// The folder of temporary files is not there or cannot be written.
    pub fn new() -> Result<Self> {
        tempfile::Builder::new().prefix(PREFIX).tempdir().map(Self)
    }

    /// Its path.
    #[must_use]
    pub fn path(&self) -> &Path {
        self.0.path()
    }
}
