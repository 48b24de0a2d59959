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
mod run_row;
mod scenes;
mod shard;
mod summary;

pub use definition::Sweep;
pub(crate) use header::Header;
pub(crate) use line::{SweepLine, read_calibration, read_line};
pub(crate) use merge::{Missing, merge};
pub(crate) use plan::{Plan, PlanError};
pub(crate) use results::{Results, ResultsError};
pub use run::SweepRun;
pub(crate) use run_row::{RunRow, run_rows};
pub use scenes::ScenesOf;
pub(crate) use scenes::SweepScenes;
pub use shard::Shard;
pub(crate) use summary::{SweepCurve, SweepGroup, SweepPoint, SweepSummary};
