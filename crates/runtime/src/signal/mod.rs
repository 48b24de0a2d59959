//! What crosses between a robot, real or simulated, and the loop that drives it: samples one way, commands the other.

mod command;
mod sample;

pub use command::Command;
pub use sample::{MAX_WHISKERS, Reading, Sample};
