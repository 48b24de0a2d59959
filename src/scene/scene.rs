//! A scene.

use super::clearance::overlap;
use super::{Expectation, FileReference, Stop, Truth, WorldKind};
use crate::geometry::Pose;
use crate::physics::Physics;
use crate::solid::Solid;
use vibrissa_runtime::rig::Rig;

/// A scenario after reading and validation.
#[derive(Debug, Clone)]
pub struct Scene {
    /// The name under which results are reported. It is a valid file name.
    pub name: String,
    /// A description for people, possibly empty.
    pub description: String,
    /// The platform, its whiskers and its sensors.
    pub rig: Rig,
    /// The physics settings.
    pub physics: Physics,
    /// The solids, at least one. None overlaps another.
    pub solids: Vec<Solid>,
    /// The exact geometry for scores.
    pub truth: Truth,
    /// The pose of the platform at the start, at rest (world frame).
    pub start: Pose,
    /// The stop condition.
    pub stop: Stop,
    /// The expectations.
    pub expect: Vec<Expectation>,
    /// The default policy.
    pub policy: Option<FileReference>,
    /// The default simulator.
    pub world: Option<WorldKind>,
    /// The seed of the sensor noise.
    pub seed: u64,
}

impl Scene {
    /// True if the rig at `start`, with undeflected whiskers, is clear of all solids.
    #[must_use]
    pub fn is_clear_at(&self, start: &Pose) -> bool {
        self.solids.iter().all(|solid| overlap(&self.rig, start, solid.outline()).is_none())
    }
}
