//! The hash that names a machine.

use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use crate::hex;

/// Number of bytes of a SHA-256.
const LENGTH: usize = 32;

/// SHA-256 of all bytes of an artifact. Its text has 64 hexadecimal digits in lower case.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(into = "String", try_from = "String")]
pub struct MachineHash([u8; LENGTH]);

/// The error for a text that is no [`MachineHash`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("the hash of a machine has 64 hexadecimal digits in lower case; copy it from the status of the store")]
pub struct ParseHashError;

impl MachineHash {
    /// The hash of an artifact.
    #[must_use]
    pub fn of(artifact: &[u8]) -> Self {
        Self(Sha256::digest(artifact).into())
    }
}

impl fmt::Display for MachineHash {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&hex::encode(&self.0))
    }
}

impl fmt::Debug for MachineHash {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

impl FromStr for MachineHash {
    type Err = ParseHashError;

    fn from_str(text: &str) -> Result<Self, ParseHashError> {
        let is_lower_case = !text.bytes().any(|digit| digit.is_ascii_uppercase());
        let bytes = hex::decode(text).filter(|_| is_lower_case).and_then(|bytes| bytes.try_into().ok());
        bytes.map(Self).ok_or(ParseHashError)
    }
}

impl From<MachineHash> for String {
    fn from(hash: MachineHash) -> Self {
        hash.to_string()
    }
}

impl TryFrom<String> for MachineHash {
    type Error = ParseHashError;

    fn try_from(text: String) -> Result<Self, ParseHashError> {
        text.parse()
    }
}
