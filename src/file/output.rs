//! A place that a command writes to.

use std::fmt;
use std::fs::File;
use std::io::{Error, Write, stderr, stdout};
use std::path::{Path, PathBuf};

use super::replace::replace;

/// A place that a command may write to: nothing that it reads, and nothing that it writes elsewhere. [`CommandFiles`](super::CommandFiles) gives it.
#[derive(Debug)]
pub struct Output {
    argument: &'static str,
    path: PathBuf,
    way: Way,
}

/// How to write.
#[derive(Debug)]
pub(super) enum Way {
    /// By a new file in the place of the old one.
    Replace,
    /// What is no regular file, such as a pipe, is open and written to.
    Open(File),
    /// What is one of the program's own streams, under whatever name, goes there with the rest.
    Stream(Stream),
}

/// A stream of the program.
#[derive(Debug, Clone, Copy)]
pub(super) enum Stream {
    Output,
    Error,
}

impl fmt::Display for Stream {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Output => "standard output",
            Self::Error => "standard error",
        })
    }
}

/// Why nothing is written to a place.
#[derive(Debug, thiserror::Error)]
pub enum OutputError {
    /// It cannot be written.
    #[error("cannot write {}: {cause}; give another place with {argument}", path.display())]
    Unwritable {
        /// The argument that names the place, or its folder.
        argument: &'static str,
        /// The place.
        path: PathBuf,
        /// Why.
        cause: Error,
    },
    /// The command reads it.
    #[error("cannot write {}: this command reads it as {}; give another place with {argument}", path.display(), input.display())]
    Input {
        /// The argument that names the place, or its folder.
        argument: &'static str,
        /// The place.
        path: PathBuf,
        /// The same file, as it was read.
        input: PathBuf,
    },
    /// The command writes something else to it.
    #[error("cannot write {}: {other_argument} writes it as {}; give another place with {argument}", path.display(), other.display())]
    Twice {
        /// The argument that names the place, or its folder.
        argument: &'static str,
        /// The place.
        path: PathBuf,
        /// The argument that names it first.
        other_argument: &'static str,
        /// The same place, as that names it.
        other: PathBuf,
    },
}

impl Output {
    pub(super) fn new(argument: &'static str, path: &Path, way: Way) -> Self {
        Self { argument, path: path.to_owned(), way }
    }

    /// The place, as the command line names it.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Writes it, as a whole or not at all if it is a regular file.
    ///
    /// # Errors
    /// [`OutputError::Unwritable`].
    pub fn write(self, content: impl AsRef<[u8]>) -> Result<(), OutputError> {
        let content = content.as_ref();
        let Self { argument, path, way } = self;
        let written = match way {
            Way::Replace => replace(&path, content),
            Way::Open(mut file) => file.write_all(content),
            Way::Stream(Stream::Output) => stdout().write_all(content).and_then(|()| stdout().flush()),
            Way::Stream(Stream::Error) => stderr().write_all(content),
        };
        written.map_err(|cause| OutputError::Unwritable { argument, path, cause })
    }
}
