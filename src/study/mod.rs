//! Policies over scenarios: a run in full, from a scene and a program to its trace; many runs at once; the bench; families of
//! scenes; policies against each other.

pub mod bench;
pub mod calibrate;
pub mod compare;
pub mod estimators;
mod execute;
pub mod families;
mod judge;
mod parallel;

use execute::build;
pub use execute::{ExecuteError, engine_hash, execute};
pub use judge::violations;
pub use parallel::{in_parallel, processors};
