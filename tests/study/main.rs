//! Runs, scores, studies and reports.

#![allow(clippy::unwrap_used, reason = "a test may panic")]
#![allow(clippy::disallowed_methods, reason = "a test may open files")]

mod chart;
#[path = "../common/mod.rs"]
mod common;
mod inspect;
mod report;
mod run;
mod runs;
mod score;
#[path = "../common/seen.rs"]
mod seen;
#[path = "../common/snapshots.rs"]
mod snapshots;
mod study;
