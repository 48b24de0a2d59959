//! The program on the robot: command line, threads, system buses.

mod command_line;
mod drive;
mod event_log;
mod machine_run;
mod measure;
mod real_time;
mod receive;
mod recorder;
mod sensors;
mod status;
mod store_options;
mod system_bus;
mod system_clock;
mod threads;
mod verdict;

pub use command_line::main;
pub use real_time::RealTime;
pub use system_bus::{SystemBus, SystemBusError};
pub use system_clock::SystemClock;
pub use threads::{PoseReceiver, Robot, ThreadError, Threads};
