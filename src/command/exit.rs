//! The exit status of a command.

use std::process::ExitCode;

/// The exit status of a command.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Exit {
    /// Done, and all expectations held.
    Done,
    /// An expectation failed.
    Unexpected,
    /// The input cannot be used.
    Unusable,
    /// The program has a fault.
    Internal,
    /// The user interrupted the program.
    Interrupted,
}

impl Exit {
    /// The number for the shell.
    #[must_use]
    pub const fn status(self) -> u8 {
        match self {
            Self::Done => 0,
            Self::Unexpected => 1,
            Self::Unusable => 2,
            Self::Internal => 3,
            // The usual status after Ctrl-C: 128 plus the number of the signal.
            Self::Interrupted => 130,
        }
    }
}

impl From<Exit> for ExitCode {
    fn from(exit: Exit) -> Self {
        Self::from(exit.status())
    }
}
