//! Policies over scenarios: a run in full, from a scene and a program to its trace.

mod execute;

pub use execute::{ExecuteError, WorldKind, engine_hash, execute};
