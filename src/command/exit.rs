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
    /// The program is at fault.
    Internal,
    /// Somebody ended it.
    Interrupted,
}

impl Exit {
    /// The number that the shell gets.
    #[must_use]
    pub const fn status(self) -> u8 {
        match self {
            Self::Done => 0,
            Self::Unexpected => 1,
            Self::Unusable => 2,
            Self::Internal => 3,
            // What shells give for a program that Ctrl-C ended: 128 and the signal's number.
            Self::Interrupted => 130,
        }
    }
}

impl From<Exit> for ExitCode {
    fn from(exit: Exit) -> Self {
        Self::from(exit.status())
    }
}
