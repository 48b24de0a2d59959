//! The statechart of a policy, and its three renderings.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

#[path = "../common/seen.rs"]
mod seen;

mod charts;
mod machine;
mod picture;
#[path = "../common/snapshots.rs"]
mod snapshots;
mod text;
