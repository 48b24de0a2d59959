//! The control loop in a world, and its trace.

mod contract;
mod drive;
mod monitor;
mod passage_watch;
mod run_map;
mod stall_watch;
mod stepped_run;
mod stopwatch;
mod trace;

pub use contract::{ContractMargin, ContractRecord};
pub use drive::{Progress, Run, Watcher, drive};
pub use monitor::{Ending, Monitor};
pub use passage_watch::PassageWatch;
pub use run_map::{MapStage, RunMap};
pub use stepped_run::{Step, SteppedRun};
pub(crate) use stopwatch::Stopwatch;
pub use trace::{Contact, MESSAGES_KEPT, MarkRecord, MessageRecord, PlotRecord, TickRecord, Trace, WhiskerRecord};
