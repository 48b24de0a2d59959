//! Scenarios: a rig, an object, a start, when to stop, and what must hold.
//!
//! A scenario is written in YAML, with a unit on every quantity, and becomes a [`Scene`]: exact geometry and SI numbers,
//! checked as a whole. What is wrong with the text is told in [diagnostics](crate::diagnostic), all at once where that is
//! possible.

mod clearance;
mod expectation;
mod rig;
mod scenario;
mod stop;
mod yaml;

pub use expectation::{Expectation, Metric, Outcome, Violation};
pub use rig::{Hinge, Physics, Platform, Rig, Sensing, Shaft, Whisker};
pub use scenario::Scene;
pub use stop::{LoopClosed, Stop};
