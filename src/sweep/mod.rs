//! Sweeps: the definition, its runs in worker processes, and the file of results.

mod axis;
mod definition;
mod header;
mod line;
mod lines;
mod merge;
mod plan;
mod read;
mod results;
mod run;
mod scenes;
mod shard;
mod summary;

pub use definition::Sweep;
pub use header::Header;
pub use line::{SweepLine, read_line};
pub use merge::{Merged, Missing, merge};
pub(crate) use plan::{Plan, PlanError};
pub use results::{Results, ResultsError};
pub use run::SweepRun;
pub use scenes::{ScenesOf, SweepScenes};
pub use shard::Shard;
pub use summary::{SweepGroup, SweepSummary};
