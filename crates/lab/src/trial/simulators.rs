//! The simulators. A new one is an implementation of [`World`], its name in [`WorldKind`], and its entry here.

use std::error::Error;

#[cfg(feature = "sim")]
use vibrissa_mujoco::{MujocoError, MujocoWorld};
use vibrissa_runtime::rig::Rig;
use vibrissa_world::geometry::Pose;
use vibrissa_world::physics::Physics;
use vibrissa_world::quasi_static::{self, QuasiStaticWorld};
use vibrissa_world::scene::WorldKind;
use vibrissa_world::solid::{PartsError, Solid};
use vibrissa_world::world::{Decision, World};

/// The error of a simulator that is not there or that refuses a scene.
#[derive(Debug, thiserror::Error)]
pub enum SimulatorError {
    /// The program was built without the simulator.
    #[error(
        "this build has no simulator `{0}`; build the program with the feature `sim`, or use the simulator `quasistatic`"
    )]
    Missing(WorldKind),
    /// A solid is too large for MuJoCo.
    #[error("{0}, or use the simulator `quasistatic`")]
    TooLarge(PartsError),
    /// The simulator refuses the scene, or its library cannot be loaded.
    #[error(transparent)]
    Refused(Box<dyn Error + Send + Sync>),
}

impl SimulatorError {
    fn refused(cause: impl Error + Send + Sync + 'static) -> Self {
        Self::Refused(Box::new(cause))
    }
}

/// A rig at its start among solids.
pub(super) struct Surroundings<'s> {
    pub(super) rig: &'s Rig,
    pub(super) physics: &'s Physics,
    pub(super) solids: &'s [Solid],
    pub(super) start: Pose,
}

/// Builds a world, pruned or whole, with a seed.
type Build = fn(&Surroundings<'_>, bool, u64) -> Result<Box<dyn World>, SimulatorError>;

/// A simulator.
pub(super) struct Simulator {
    /// Builds a world, pruned or whole. The seed fixes the noise of sensors and poses.
    pub(super) build: Build,
    /// Checks that the build has it and that its library can be loaded.
    pub(super) check: fn() -> Result<(), SimulatorError>,
    /// The version of its library. `None` for a simulator that is a part of this program.
    pub(super) version: fn() -> Option<&'static str>,
    /// What it omits.
    pub(super) decisions: fn(&Surroundings<'_>) -> Result<Vec<Decision>, SimulatorError>,
}

impl Simulator {
    /// The simulator with a name.
    pub(super) fn of(kind: WorldKind) -> &'static Self {
        match kind {
            WorldKind::Mujoco => &MUJOCO,
            WorldKind::QuasiStatic => &QUASI_STATIC,
        }
    }
}

static QUASI_STATIC: Simulator = Simulator {
    build: |&Surroundings { rig, physics, solids, start }, _prune, seed| {
        let world = QuasiStaticWorld::new(rig, physics, solids, start, seed).map_err(SimulatorError::refused)?;
        Ok(Box::new(world))
    },
    check: || Ok(()),
    version: || None,
    decisions: |_| Ok(quasi_static::decisions()),
};

#[cfg(feature = "sim")]
static MUJOCO: Simulator = Simulator {
    build: |&Surroundings { rig, physics, solids, start }, prune, seed| {
        let build = if prune { MujocoWorld::pruned } else { MujocoWorld::new };
        let world = build(rig, physics, solids, start, seed).map_err(|cause| match cause {
            MujocoError::Parts(cause) => SimulatorError::TooLarge(cause),
            cause => SimulatorError::refused(cause),
        })?;
        Ok(Box::new(world))
    },
    check: || vibrissa_mujoco::engine_version().map(|_| ()).map_err(SimulatorError::refused),
    version: || Some(vibrissa_mujoco::engine_version().unwrap_or("none")),
    decisions: mujoco_decisions,
};

#[cfg(not(feature = "sim"))]
static MUJOCO: Simulator = Simulator {
    build: |_, _, _| Err(SimulatorError::Missing(WorldKind::Mujoco)),
    check: || Err(SimulatorError::Missing(WorldKind::Mujoco)),
    version: || Some("none"),
    decisions: mujoco_decisions,
};

/// What MuJoCo omits follows from the scene alone, without its library.
fn mujoco_decisions(
    &Surroundings { rig, physics, solids, start }: &Surroundings<'_>,
) -> Result<Vec<Decision>, SimulatorError> {
    vibrissa_mujoco::decisions(rig, physics, solids, start).map_err(SimulatorError::TooLarge)
}
