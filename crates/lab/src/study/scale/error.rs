//! The errors of measurements of scale.

use std::path::PathBuf;
use vibrissa_text::system::in_words;

use vibrissa_text::file::OutputError;

use crate::sweep::ResultsError;
use crate::trial::ExecuteError;

/// Where the folder of temporary files is from.
pub(super) const FOLDER: &str = "the environment variable TMPDIR";

/// The error of a measurement of scale.
#[derive(Debug, thiserror::Error)]
pub enum ScaleError {
    /// A text that the program makes cannot be read.
    #[error("a case of the axis cannot be made: {0}; this is a fault of the program, please report it")]
    Text(String),
    /// A run cannot begin.
    #[error(transparent)]
    Execute(#[from] ExecuteError),
    /// A temporary file cannot be used.
    #[error("cannot use {}: {words}; give another path with {FOLDER}", path.display(), words = in_words(cause))]
    File {
        /// The file or folder.
        path: PathBuf,
        /// The cause.
        cause: std::io::Error,
    },
    /// A temporary file cannot be written.
    #[error(transparent)]
    Output(#[from] OutputError),
    /// The results of a sweep cannot be merged.
    #[error(transparent)]
    Results(#[from] ResultsError),
    /// A job of a sweep cannot be started, or fails.
    #[error("a job of a sweep failed: {0}; run `vibrissa sweep` by itself to see why")]
    Job(String),
}

impl ScaleError {
    pub(super) fn file(path: impl Into<PathBuf>) -> impl FnOnce(std::io::Error) -> Self {
        let path = path.into();
        move |cause| Self::File { path, cause }
    }
}
