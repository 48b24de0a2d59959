//! Scenarios, benchmarks and a policy language for whisker-based active touch.

// The code that pest writes for a grammar without `std` names it.
extern crate alloc;

pub mod built_in;
pub mod calibration;
mod command;
pub mod diagnostic;
#[cfg(feature = "lsp")]
mod editor;
pub mod family;
pub mod file;
pub mod geometry;
mod load;
pub mod mujoco;
pub mod outline;
pub mod physics;
pub mod policy;
pub mod quasi_static;
pub mod report;
pub mod results;
pub mod run;
pub mod scenario;
pub mod scene;
pub mod score;
pub mod solid;
pub mod study;
pub mod sweep;
pub mod trial;
pub mod world;

#[doc(hidden)]
pub use command::main as command_line;
