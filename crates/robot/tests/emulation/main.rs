//! The loop in emulated time.
#![allow(clippy::unwrap_used, clippy::disallowed_methods, reason = "a test may panic and open files")]

mod admission;
mod artifacts;
mod campaign;
mod damage;
mod fields;
mod kept;
mod links;
mod panic;
mod recorder;
mod recording;
mod replay;
mod robot;
mod steady;
