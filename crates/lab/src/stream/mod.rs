//! A run as pages show it: its first message, and a frame for each tick.
//!
//! The live page gets these messages over a socket, and the playground gets them from its own machine in the browser.

mod change;
mod counterfactual;
mod frame;
mod guards;
mod hello;
mod map;
pub mod message;
mod sample_store;
mod setup;
mod shadow;
mod shape;

pub use change::Changeable;
pub use counterfactual::{Counterfactual, PastRun, Question, RunFacts, TickResult};
pub use frame::{Frames, drawn_pose, rounded};
pub use guards::GuardNumbers;
pub use hello::{breakpoints, breakpoints_with, hello};
pub use sample_store::SampleStore;
pub use setup::RunSetup;
pub use shadow::Shadow;
pub use shape::{outline_points, shaft_points};
