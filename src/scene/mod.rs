//! Scenarios: a rig, an object, a start, when to stop, what must hold; and the MuJoCo model that they become.
//!
//! A scenario is written in YAML, with a unit on every quantity, and becomes a [`Scene`]: exact geometry and SI numbers,
//! checked as a whole. What is wrong with the text is told in [diagnostics](crate::diagnostic), all at once where that is
//! possible.

mod clearance;
mod expectation;
mod gap;
mod mjcf;
mod scenario;
mod solid;
mod stop;
mod yaml;

pub use expectation::{Expectation, Metric, Outcome, Violation};
pub use mjcf::mjcf;
pub use scenario::Scene;
pub use solid::SolidError;
pub use stop::{LoopClosed, Stop};
