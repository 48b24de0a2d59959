//! The crate of the robot: perception, mechanics and motion.

#![allow(clippy::unwrap_used, reason = "a test may panic")]
#![allow(clippy::disallowed_methods, reason = "a test may open files")]

#[path = "../common/mod.rs"]
mod common;
mod mechanics;
mod motion;
mod percept;
