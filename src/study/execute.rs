//! One run: build the world, drive it, give what happened.

use std::fmt;
use std::ops::ControlFlow;
use std::sync::Arc;

use sha2::{Digest, Sha256};

use crate::machine::Program;
use crate::run::{BindError, Control, Run, Trace, drive};
use crate::scene::{Scene, mjcf};

/// The worlds that a run can take place in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum WorldKind {
    /// The simulation by MuJoCo.
    Mujoco,
}

impl fmt::Display for WorldKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Mujoco => f.write_str("mujoco"),
        }
    }
}

/// Why a run could not begin.
#[derive(Debug, thiserror::Error)]
pub enum ExecuteError {
    /// The scenario's rig does not have what the policy needs.
    #[error(transparent)]
    Bind(#[from] BindError),
    /// It was broken off.
    #[error("the run was broken off")]
    Interrupted,
    /// The world could not be built.
    #[cfg(feature = "sim")]
    #[error(transparent)]
    Mujoco(#[from] crate::world::MujocoError),
    /// The program was built without the world.
    #[cfg(not(feature = "sim"))]
    #[error("this build has no world `{0}`; build it with the feature `sim`")]
    NoWorld(WorldKind),
}

/// Runs `program` in `scene`; `seed` fixes the sensors' noise. At every tick `progress` hears what has happened so far, and
/// may break the run off.
///
/// # Errors
/// [`ExecuteError`] when the run cannot begin. How it ends is in the [`Run`].
pub fn execute(
    scene: &Scene,
    program: Arc<Program>,
    world: WorldKind,
    seed: u64,
    progress: impl FnMut(&Trace) -> ControlFlow<()>,
) -> Result<Run, ExecuteError> {
    let control = Control::new(&scene.rig, program)?;
    let mut world = build(scene, world, seed)?;
    let period = 1.0 / scene.rig.sensing.control_rate;
    drive(world.as_mut(), control, &scene.stop, period, progress).ok_or(ExecuteError::Interrupted)
}

#[cfg(feature = "sim")]
fn build(scene: &Scene, kind: WorldKind, seed: u64) -> Result<Box<dyn crate::world::World>, ExecuteError> {
    match kind {
        WorldKind::Mujoco => {
            let world = crate::world::MujocoWorld::new(&scene.rig, &scene.solids, scene.start, seed)?;
            Ok(Box::new(world))
        }
    }
}

#[cfg(not(feature = "sim"))]
fn build(_: &Scene, kind: WorldKind, _: u64) -> Result<Box<dyn crate::world::World>, ExecuteError> {
    Err(ExecuteError::NoWorld(kind))
}

impl WorldKind {
    /// Checks that this build has the world.
    ///
    /// # Errors
    /// It was built without.
    pub fn check(self) -> Result<(), ExecuteError> {
        #[cfg(feature = "sim")]
        return Ok(());
        #[cfg(not(feature = "sim"))]
        return Err(ExecuteError::NoWorld(self));
    }
}

/// The versions of this program and of the simulator.
#[must_use]
pub fn engine_version() -> String {
    format!("{} with {}", env!("CARGO_PKG_VERSION"), simulator())
}

fn simulator() -> &'static str {
    #[cfg(feature = "sim")]
    return crate::world::engine_version();
    #[cfg(not(feature = "sim"))]
    return "none";
}

/// A hash of everything but scenario and policy that a run depends on: this program's version, the simulator's, and the
/// model that it is given.
#[must_use]
pub fn engine_hash(scene: &Scene) -> [u8; 32] {
    let mut hash = Sha256::new();
    hash.update(env!("CARGO_PKG_VERSION"));
    hash.update([0]);
    hash.update(simulator());
    hash.update([0]);
    hash.update(mjcf(&scene.rig, &scene.solids, scene.start));
    hash.finalize().into()
}
