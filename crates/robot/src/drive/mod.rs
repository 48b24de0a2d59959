//! The loop: control, supervision and the threads that run them.

mod control_task;
mod loop_record;
mod record_sink;
mod report;
mod schedule;
mod supervisor;
mod violations;

pub use control_task::{ControlTask, Inputs, Outputs, Started, kept_for};
pub use loop_record::{LoopRecord, RecordSender, Records, StepInput, TimedMessage, Violation, record_queues};
pub use record_sink::RecordSink;
pub use report::TickReport;
pub use schedule::StepTime;
pub(crate) use schedule::{QUEUE, SUPERVISION_NS, tick_offset_ns};
pub use supervisor::Supervisor;
