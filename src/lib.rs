//! Scenarios, benchmarks and a policy language for whisker-based active touch.

// What pest writes for a grammar without `std` names it.
extern crate alloc;

pub mod calibration;
pub mod cli;
pub mod diagnostic;
#[cfg(feature = "lsp")]
pub mod editor;
pub mod family;
pub mod file;
pub mod geometry;
pub mod mujoco;
pub mod outline;
pub mod physics;
pub mod policy;
pub mod quasi_static;
pub mod report;
pub mod run;
pub mod scenario;
pub mod scene;
pub mod score;
pub mod solid;
pub mod study;
pub mod sweep;
pub mod world;
