//! Errors of requests.

use std::error::Error;
use std::fmt;

use crate::load::LoadError;
use crate::trial::TrialFault;
use vibrissa_text::diagnostic::{Colour, terminal};

/// The error of a request whose files, texts or options cannot be used. Its text is what the program prints. Errors of a
/// text have their positions and lines.
#[derive(Debug)]
pub struct RequestError(TrialFault);

impl RequestError {
    /// The cause.
    #[must_use]
    pub fn into_fault(self) -> TrialFault {
        self.0
    }
}

impl<F: Into<TrialFault>> From<F> for RequestError {
    fn from(fault: F) -> Self {
        Self(fault.into())
    }
}

impl fmt::Display for RequestError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.0 {
            TrialFault::Load(LoadError::Faults { source_text, faults }) => {
                f.write_str(terminal(source_text, faults, Colour::Plain).trim_end())
            }
            fault => fault.fmt(f),
        }
    }
}

impl Error for RequestError {}
