//! The sensor array: acquisition of rounds, and their assembly to samples.

mod acquisition;
mod assembler;
mod bus;
mod magnet;
mod pose_history;
mod round;
mod transducer;
mod zero;
mod zeroing;

pub use acquisition::{Acquisition, StartFault};
pub use assembler::{Assembler, period_ns};
pub use bus::Bus;
pub(crate) use bus::Port;
pub use magnet::Magnet;
pub use pose_history::{PoseHistory, StampedPose, is_plausible_pose};
pub use round::{BoardReading, ReadingState, Round};
pub use transducer::Transducer;
pub use zeroing::{Zeroing, ZeroingFault};
