//! Scenarios: a rig, objects, a start, when to stop, what must hold; and the MuJoCo model that they become.
//!
//! A scenario is written in YAML, with a unit on every quantity, and becomes a [`Scene`]: exact geometry and SI numbers,
//! checked as a whole. What is wrong with the text is told in [diagnostics](crate::diagnostic), all at once where that is
//! possible.

mod clearance;
mod contacts;
mod decompose;
mod expectation;
pub mod family;
mod file_reference;
mod gap;
mod jitter;
mod mjcf;
mod part;
mod prune;
mod scenario;
mod solid;
mod stop;
mod sweep;
mod truth;
mod wall;
mod world_kind;
mod yaml;

pub(crate) use clearance::{Overlap, overlap};
pub use expectation::{Expectation, Metric, Outcome, Violation};
pub use file_reference::FileReference;
pub(crate) use gap::gap;
pub use jitter::Jitter;
pub use mjcf::{mjcf, mjcf_within, part_names};
pub use part::Part;
pub use prune::{Decision, Pruning, Reach, Scope, Verdict, is_gentle, may_be_rigid};
pub use scenario::{Files, Scene};
pub use solid::{Solid, SolidError};
pub use stop::{LoopClosed, Reached, Stalled, Stop};
pub use sweep::{ScenesOf, Sweep, SweepRun, SweepScenes};
pub use truth::Truth;
pub use world_kind::{WorldKind, WorldSetup};
