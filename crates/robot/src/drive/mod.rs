//! The loop: control, supervision and the threads that run them.

mod control_task;
mod report;
mod supervisor;

pub use control_task::{ControlTask, Inputs, Outputs, Started};
pub use report::TickReport;
pub use supervisor::Supervisor;
