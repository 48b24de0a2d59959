//! A scene: a rig, solids, a start pose, a stop condition and expectations.

mod clearance;
mod expectation;
mod file_reference;
mod gap;
mod jitter;
mod scene;
mod stop;
mod truth;
mod world_kind;

pub(crate) use clearance::{Overlap, overlap};
pub use expectation::{Expectation, Metric, Outcome, Violation};
pub use file_reference::FileReference;
pub(crate) use gap::gap;
pub use jitter::Jitter;
pub use scene::Scene;
pub use stop::{LoopClosed, Reached, Stalled, Stop};
pub use truth::Truth;
pub use world_kind::{WorldKind, WorldSetup};
