//! Policies over scenarios: a run in full, from a scene and a program to its trace; many runs at once; the bench; families of
//! scenes; policies against each other; worlds against each other; sweeps.

pub mod bench;
pub mod compare;
pub mod estimators;
mod execute;
mod judge;
mod parallel;
pub mod pareto;
mod processor_time;
pub mod stress;
mod tally;
pub mod tiers;

use execute::build;
pub use execute::{ExecuteError, check_world, engine_hash, engine_version, execute};
pub use judge::violations;
pub use parallel::{Threads, in_parallel, processors, stream_in_parallel};
pub use tally::{Ending, Figures, Tally, TipShares};
