//! The interface between a robot, real or simulated, and its control loop: samples and commands.

mod command;
mod sample;

pub use command::Command;
pub use sample::{MAX_WHISKERS, Reading, Sample, TrueTip};
