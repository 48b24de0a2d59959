//! The answer of the robot to a push.

use std::fmt;

use serde::{Deserialize, Serialize};

use super::machine_hash::MachineHash;
use super::state::Role;

/// The answer of the robot to a push: one line of JSON, such as `{"hash":"…","state":"tentative"}`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Answer {
    /// The machine.
    pub hash: MachineHash,
    /// Its role now. It is [`Role::Good`] if the good machine was pushed again.
    pub state: Role,
}

impl Answer {
    /// Reads the line.
    pub(super) fn from_line(line: &str) -> Option<Self> {
        serde_json::from_str(line).ok()
    }
}

/// The line, without a line end.
impl fmt::Display for Answer {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&serde_json::to_string(self).map_err(|_| fmt::Error)?)
    }
}
