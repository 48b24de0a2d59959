//! The loop: sample, perceive, decide, command; and the trace of what happened.

mod control;
mod drive;
mod trace;

pub use control::Control;
pub use drive::{Run, drive};
pub use trace::{TickRecord, Trace};
