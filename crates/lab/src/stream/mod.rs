//! A run as pages show it: its first message, and a frame for each tick.
//!
//! The live page gets these messages over a socket, and the playground gets them from its own machine in the browser.

mod change;
mod frame;
mod guards;
mod hello;
pub mod message;
mod setup;
mod shadow;
mod shape;

pub use change::Changeable;
pub use frame::{Frames, drawn_pose, rounded};
pub use guards::GuardNumbers;
pub use hello::{breakpoints, hello};
pub use setup::RunSetup;
pub use shadow::Shadow;
pub use shape::{outline_points, shaft_points};
