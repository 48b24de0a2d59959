//! Policies over scenarios: a run in full, from a scene and a program to its trace.

mod execute;
mod judge;

pub use execute::{ExecuteError, WorldKind, engine_hash, execute};
pub use judge::violations;
