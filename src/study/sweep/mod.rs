//! Sweeps: many runs, each in a process that it may end, their results a line each in a file that can be gone on with.

mod header;
mod line;
mod lines;
mod merge;
mod results;
mod shard;
mod summary;
mod worker;

pub use header::Header;
pub use line::{SweepLine, read_line};
pub use merge::{Merged, Missing, merge};
pub use results::{Results, ResultsError};
pub use shard::Shard;
pub use summary::{SweepGroup, SweepSummary, summary_table};
pub use worker::{Answer, StartError, Worker, answer};
