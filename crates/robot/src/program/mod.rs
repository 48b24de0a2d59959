//! The program on the robot: command line, threads, system buses.

mod command_line;
mod control;
mod drive;
mod event_log;
mod links;
mod machine_run;
mod measure;
mod real_time;
mod receive;
mod recorder;
mod sensor_io;
mod sensors;
mod service_threads;
mod status;
mod store_options;
mod system_bus;
mod system_clock;
mod thread_bodies;
mod threads;
mod verdict;
mod watch;

pub use command_line::main;
pub use real_time::RealTime;
pub use system_bus::{SystemBus, SystemBusError};
pub use system_clock::SystemClock;
pub use threads::{OpenBus, PoseReceiver, Robot, ThreadError, Threads};
