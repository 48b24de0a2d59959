//! The control loop in a world, and its trace.

mod drive;
mod monitor;
mod stall_watch;
mod trace;

pub use drive::{Progress, Run, Watcher, drive};
pub use monitor::{Ending, Monitor};
pub use trace::{Contact, MarkRecord, TickRecord, Trace};
