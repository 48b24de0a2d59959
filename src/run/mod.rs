//! The control loop in a world, and its trace.

mod drive;
mod loop_watch;
mod stall_watch;
mod trace;

pub use drive::{Run, drive};
pub use trace::{Contact, MarkRecord, TickRecord, Trace};
