//! Policies over scenarios: a run in full, from a scene and a program to its trace; many runs at once; the bench; families of
//! scenes; policies against each other.

pub mod bench;
pub mod compare;
mod execute;
pub mod families;
mod judge;
mod parallel;

pub use execute::{ExecuteError, engine_hash, execute};
pub use judge::violations;
pub use parallel::{in_parallel, processors};
