//! The file with the state of a store.

use serde::{Deserialize, Serialize};

use super::state::State;

/// Its name in the store.
pub(super) const STATE_FILE: &str = "state.json";
/// Maximum size of the file in bytes.
pub(super) const STATE_LIMIT: usize = 64 << 10;
/// Number of the format of the file.
const FORMAT: u32 = 1;

/// The content of the file.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Content {
    format: u32,
    state: State,
}

/// The part of the content that has the same form in all formats.
#[derive(Deserialize)]
struct Head {
    format: u32,
}

/// The problem of a file with a state.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum StateFileError {
    /// It is not JSON with the right fields.
    #[error("it is damaged: {0}")]
    Damaged(String),
    /// It has another format.
    #[error("it is in format {found}, and this program reads format {FORMAT}")]
    Format {
        /// Number of that format.
        found: u32,
    },
    /// It names a machine twice.
    #[error("it is damaged: it names a machine twice")]
    Inconsistent,
}

/// Encodes a state.
pub(super) fn encode(state: &State) -> Result<Vec<u8>, StateFileError> {
    let content = Content { format: FORMAT, state: state.clone() };
    serde_json::to_vec_pretty(&content).map_err(|cause| StateFileError::Damaged(cause.to_string()))
}

/// Decodes a state.
pub(super) fn decode(bytes: &[u8]) -> Result<State, StateFileError> {
    let damaged = |cause: serde_json::Error| StateFileError::Damaged(cause.to_string());
    let head: Head = serde_json::from_slice(bytes).map_err(damaged)?;
    if head.format != FORMAT {
        return Err(StateFileError::Format { found: head.format });
    }
    let content: Content = serde_json::from_slice(bytes).map_err(damaged)?;
    if content.state.is_consistent() { Ok(content.state) } else { Err(StateFileError::Inconsistent) }
}
