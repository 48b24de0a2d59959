//! The loop: sample, perceive, decide, command; and the trace of what happened.

mod drive;
mod loop_watch;
mod stall_watch;
mod trace;

pub use drive::{Run, drive};
pub use trace::{MarkRecord, TickRecord, Touch, Trace};
