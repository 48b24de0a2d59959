//! Why there is no release.

use std::path::PathBuf;
use std::process::ExitStatus;

use thiserror::Error;

use crate::book::BookError;
use crate::cargo::NotStarted;
use crate::cross::CrossError;
use crate::pack::PackError;
use crate::pi::PiError;
use crate::playground::PlaygroundError;
use crate::python::PythonError;
use crate::setup::SetupError;

/// Why a file was not made or did not pass its check, and what to do.
#[derive(Debug, Error)]
pub(crate) enum ReleaseError {
    #[error(transparent)]
    Setup(#[from] SetupError),
    #[error(transparent)]
    Cross(#[from] CrossError),
    #[error(transparent)]
    Pi(#[from] PiError),
    #[error(transparent)]
    Python(#[from] PythonError),
    #[error(transparent)]
    Playground(#[from] PlaygroundError),
    #[error(transparent)]
    Book(#[from] BookError),
    #[error(transparent)]
    Pack(#[from] PackError),
    #[error(transparent)]
    NotStarted(#[from] NotStarted),
    #[error("{command}: it failed ({status}); what it said is above")]
    Failed { command: String, status: ExitStatus },
    #[error("{} has no file that ends in `{end}`; the step that makes it is above", folder.display())]
    Missing { folder: PathBuf, end: &'static str },
}
