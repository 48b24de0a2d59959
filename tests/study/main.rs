//! What is made of runs: scores, reports, benches, comparisons.
#![allow(clippy::unwrap_used, reason = "a test may panic")]
#![allow(clippy::disallowed_methods, reason = "a test may open files")]

mod bench;
#[path = "../common/mod.rs"]
mod common;
mod compare;
mod corners;
mod estimators;
mod hostile;
mod pareto;
mod passage;
#[cfg(feature = "sim")]
mod pruning;
mod reach;
mod report;
mod retrieval;
mod runs;
mod score;
#[path = "../common/seen.rs"]
mod seen;
#[path = "../common/snapshots.rs"]
mod snapshots;
mod ticks;
mod united;
mod verdicts;
mod way;
mod worlds;
