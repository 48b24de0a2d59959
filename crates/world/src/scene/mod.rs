//! A scene: a rig, solids, a start pose, a stop condition and expectations.

mod clearance;
mod expectation;
mod gap;
mod jitter;
#[expect(clippy::module_inception, reason = "one noun a file, and this one is the module's name")]
mod scene;
mod stop;
mod world_kind;

pub(crate) use clearance::{Overlap, overlap};
pub use expectation::{Expectation, Outcome, Violation};
pub use gap::gap;
pub use jitter::Jitter;
pub use scene::{FileReference, PolicyReference, PolicySetting, Scene, SelfCalibration, Truth};
pub use stop::{Goal, LoopClosed, Reached, Stalled, Stop};
pub use world_kind::{WorldKind, WorldSetup};
