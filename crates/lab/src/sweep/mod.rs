//! Sweeps: the definition, its runs in worker processes, and the file of results.

mod axis;
mod definition;
mod family_axis;
mod header;
mod line;
mod lines;
mod merge;
mod plan;
mod read;
mod results;
mod run;
mod run_rows;
mod scenes;
mod shard;
mod summary;

pub use definition::Sweep;
pub use header::Header;
pub use line::{ReadLine, SweepLine, read_line};
pub use merge::{Missing, merge};
pub use plan::Plan;
pub use results::{Results, ResultsError};
pub use run::SweepRun;
pub use run_rows::run_rows;
pub use scenes::ScenesOf;
pub(crate) use scenes::SweepScenes;
pub use shard::Shard;
pub use summary::{SweepCurve, SweepGroup, SweepPoint, SweepSummary};
