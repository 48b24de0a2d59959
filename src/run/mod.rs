//! The control loop in a world, and its trace.

mod contract;
mod drive;
mod monitor;
mod stall_watch;
mod trace;

pub use contract::{ContractMargin, ContractRecord};
pub use drive::{Progress, Run, Watcher, drive};
pub use monitor::{Ending, Monitor};
pub use trace::{Contact, MESSAGES_KEPT, MarkRecord, MessageRecord, PlotRecord, TickRecord, Trace};
