//! The simulators, and the calibration rig that is built of them.

#![allow(clippy::unwrap_used, reason = "a test may panic")]
#![allow(clippy::disallowed_methods, reason = "a test may open files")]

mod calibration;
mod curved;
mod mujoco;
mod posture;
mod quasi_static;
#[path = "../common/snapshots.rs"]
mod snapshots;
mod texture;
