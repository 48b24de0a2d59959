//! Scenarios, benchmarks and a policy language for whisker-based active touch.

// What pest writes for a grammar without `std` names it.
extern crate alloc;

pub mod calibration;
pub mod cli;
pub mod diagnostic;
#[cfg(feature = "lsp")]
pub mod editor;
pub mod file;
pub mod geometry;
pub mod machine;
pub mod mechanics;
pub mod motion;
pub mod outline;
pub mod percept;
pub mod policy;
pub mod report;
pub mod rig;
pub mod run;
pub mod scene;
pub mod score;
pub mod signal;
pub mod study;
pub mod units;
pub mod world;
