//! The loop in emulated time.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

mod admission;
mod artifacts;
mod campaign;
mod panic;
mod robot;
mod steady;
