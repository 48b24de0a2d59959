//! What there is to be touched: geometry, outlines from files, scenarios, families, solids.
#![allow(clippy::unwrap_used, reason = "a test may panic")]
#![allow(clippy::disallowed_methods, reason = "a test may open files")]

mod errors;
mod explain;
mod families;
mod geometry;
mod near;
#[cfg(feature = "outlines")]
mod outlines;
mod page;
mod scenes;
#[cfg(feature = "sim")]
mod seams;
#[path = "../common/snapshots.rs"]
mod snapshots;
mod solids;
mod sweeps;
