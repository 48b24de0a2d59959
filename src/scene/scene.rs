//! A scene.

use super::clearance::overlap;
use super::{Expectation, FileReference, Stop, Truth, WorldKind};
use crate::geometry::Pose;
use crate::physics::Physics;
use crate::solid::Solid;
use vibrissa_runtime::rig::Rig;

/// One scenario, read and checked.
#[derive(Debug, Clone)]
pub struct Scene {
    /// The name under which results are reported; fit to be a file's name.
    pub name: String,
    /// What it is about, for people; may be empty.
    pub description: String,
    /// The platform, its whiskers and its sensors.
    pub rig: Rig,
    /// The settings of the simulation.
    pub physics: Physics,
    /// What is there to be touched; at least one solid, none overlapping another.
    pub solids: Vec<Solid>,
    /// The exact geometry that estimates are measured against.
    pub truth: Truth,
    /// Where the platform starts, at rest: its centre of mass and its heading, in the world.
    pub start: Pose,
    /// When a run ends.
    pub stop: Stop,
    /// What must hold at the end of a run.
    pub expect: Vec<Expectation>,
    /// The policy to run unless another is asked for.
    pub policy: Option<FileReference>,
    /// The world to run in unless another is asked for.
    pub world: Option<WorldKind>,
    /// Seed of the sensor noise.
    pub seed: u64,
}

impl Scene {
    /// Whether the rig, its whiskers straight, would stand clear of all solids if it started at `start`.
    #[must_use]
    pub fn is_clear_at(&self, start: &Pose) -> bool {
        self.solids.iter().all(|solid| overlap(&self.rig, start, solid.outline()).is_none())
    }
}
