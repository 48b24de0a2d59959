//! An output of a command.

use crate::system::in_words;
use std::fmt;
use std::fs::File;
use std::io::{Error, ErrorKind, Write, stderr, stdout};
use std::path::{Path, PathBuf};

use super::replace::replace_with;

/// An output file of a command. The command neither reads it nor writes another output to it.
/// [`CommandFiles`](super::CommandFiles) creates outputs.
#[derive(Debug)]
pub struct Output {
    argument: &'static str,
    path: PathBuf,
    method: Method,
}

/// The method of writing.
#[derive(Debug)]
pub(super) enum Method {
    /// A new file replaces the old one.
    Replace,
    /// The file is not a regular one, such as a pipe. It is open and written to.
    Open(File),
    /// The file is one of the program's own streams, under any name. It is written through that stream.
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

/// The error for an output that cannot be written.
#[derive(Debug, thiserror::Error)]
pub enum OutputError {
    /// The file cannot be written.
    #[error("cannot write {}: {words}; give another path with {argument}", path.display(), words = in_words(cause))]
    Unwritable {
        /// The argument that names the file or its folder.
        argument: &'static str,
        /// The path.
        path: PathBuf,
        /// The cause.
        cause: Error,
    },
    /// The command reads the file.
    #[error("cannot write {}: this command reads it as {}; give another path with {argument}", path.display(), input.display())]
    Input {
        /// The argument that names the file or its folder.
        argument: &'static str,
        /// The path.
        path: PathBuf,
        /// The path under which the file was read.
        input: PathBuf,
    },
    /// The command writes another output to the file.
    #[error("cannot write {}: {other_argument} writes it as {}; give another path with {argument}", path.display(), other.display())]
    Twice {
        /// The argument that names the file or its folder.
        argument: &'static str,
        /// The path.
        path: PathBuf,
        /// The argument of the first output.
        other_argument: &'static str,
        /// The path of the first output.
        other: PathBuf,
    },
}

impl Output {
    pub(super) fn new(argument: &'static str, path: &Path, method: Method) -> Self {
        Self { argument, path: path.to_owned(), method }
    }

    /// The path on the command line.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Writes the content. A regular file is written completely or not at all.
    ///
    /// # Errors
    /// [`OutputError::Unwritable`].
    pub fn write(self, content: impl AsRef<[u8]>) -> Result<(), OutputError> {
        self.write_with(|out| out.write_all(content.as_ref()))
    }

    /// Writes a content that `write` writes piece by piece.
    ///
    /// # Errors
    /// [`OutputError::Unwritable`], also with an error of `write`. A regular file then keeps its old content.
    pub fn write_with(self, write: impl FnOnce(&mut dyn Write) -> std::io::Result<()>) -> Result<(), OutputError> {
        let Self { argument, path, method } = self;
        let written = match method {
            Method::Replace => replace_with(&path, write),
            Method::Open(mut file) => write(&mut file),
            Method::Stream(Stream::Output) => write(&mut stdout()).and_then(|()| stdout().flush()),
            Method::Stream(Stream::Error) => write(&mut stderr()),
        };
        written.map_err(|cause| OutputError::Unwritable { argument, path, cause })
    }

    /// Removes the regular file of an earlier run, for an output that this run does not have.
    ///
    /// # Errors
    /// [`OutputError::Unwritable`].
    pub fn remove(self) -> Result<(), OutputError> {
        let Self { argument, path, method: Method::Replace } = self else { return Ok(()) };
        match std::fs::remove_file(&path) {
            Err(cause) if cause.kind() != ErrorKind::NotFound => Err(OutputError::Unwritable { argument, path, cause }),
            _ => Ok(()),
        }
    }
}
