//! Artifacts: what comes back, and what does not get in.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

mod damage;
mod erratic;
mod format;
mod policies;
mod round_trip;
#[path = "../common/snapshots.rs"]
mod snapshots;
mod unsound;
