//! The loop in emulated time.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

mod campaign;
mod robot;
mod steady;
