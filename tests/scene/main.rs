//! Scenes: the format, geometry, outlines, solids, families, sweeps.

#![allow(clippy::unwrap_used, reason = "a test may panic")]
#![allow(clippy::disallowed_methods, reason = "a test may open files")]

mod drawn;
mod family;
mod geometry;
#[cfg(feature = "outlines")]
mod outline;
mod rooms;
mod scenario;
mod shapes;
#[path = "../common/snapshots.rs"]
mod snapshots;
mod solid;
mod sweep;
