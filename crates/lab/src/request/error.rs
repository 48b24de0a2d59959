//! Errors of requests.

use std::error::Error;
use std::fmt;
use std::path::PathBuf;

use vibrissa_runtime::machine::{ArtifactError, SetError};

use crate::calibration::ArrayCalibrationError;
use crate::load::LoadError;
use vibrissa_text::diagnostic::{Colour, terminal};
use vibrissa_world::mismatch::MismatchError;

/// The error of a request whose files, texts or options cannot be used. Its text is what the program prints. Errors of a
/// text have their positions and lines.
#[derive(Debug)]
pub struct RequestError(RequestFault);

/// The cause of a [`RequestError`].
#[derive(Debug)]
pub enum RequestFault {
    /// A file cannot be read or has errors.
    Load(LoadError),
    /// A compiled machine is refused.
    Machine(ArtifactError),
    /// The mismatch does not fit the scenario.
    Mismatch {
        /// The scenario.
        scenario: PathBuf,
        /// What does not fit.
        cause: MismatchError,
    },
    /// The array of the scenario cannot be calibrated.
    Calibration {
        /// The scenario.
        scenario: PathBuf,
        /// Why not.
        cause: ArrayCalibrationError,
    },
    /// A parameter of the policy cannot be set.
    Set(SetError),
}

impl RequestError {
    /// The cause.
    #[must_use]
    pub fn into_fault(self) -> RequestFault {
        self.0
    }
}

impl<F: Into<RequestFault>> From<F> for RequestError {
    fn from(fault: F) -> Self {
        Self(fault.into())
    }
}

impl From<LoadError> for RequestFault {
    fn from(error: LoadError) -> Self {
        Self::Load(error)
    }
}

impl From<ArtifactError> for RequestFault {
    fn from(error: ArtifactError) -> Self {
        Self::Machine(error)
    }
}

impl From<SetError> for RequestFault {
    fn from(error: SetError) -> Self {
        Self::Set(error)
    }
}

impl fmt::Display for RequestError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.0 {
            RequestFault::Load(LoadError::Faults { source_text, faults }) => {
                f.write_str(terminal(source_text, faults, Colour::Plain).trim_end())
            }
            RequestFault::Load(error) => error.fmt(f),
            RequestFault::Machine(error) => error.fmt(f),
            RequestFault::Mismatch { scenario, cause } => write!(f, "{}: mismatch: {cause}", scenario.display()),
            RequestFault::Calibration { scenario, cause } => {
                write!(f, "{}: the array cannot be calibrated: {cause}", scenario.display())
            }
            RequestFault::Set(error) => error.fmt(f),
        }
    }
}

impl Error for RequestError {}
