//! The worlds that this build has, and the versions of their simulators.

use sha2::{Digest, Sha256};
use vibrissa_runtime::control::BindError;
use vibrissa_runtime::rig::Rig;

#[cfg(feature = "sim")]
use vibrissa_mujoco::MujocoWorld;
use vibrissa_mujoco::mjcf;
use vibrissa_world::physics::Physics;
use vibrissa_world::quasi_static::{QuasiStaticError, QuasiStaticWorld};
use vibrissa_world::scene::{Scene, WorldKind, WorldSetup};
use vibrissa_world::world::{Disturbed, World};

/// The error of a run that cannot begin.
#[derive(Debug, thiserror::Error)]
pub enum ExecuteError {
    /// The scenario's rig does not have what the policy needs.
    #[error(transparent)]
    Bind(#[from] BindError),
    /// The run was stopped.
    #[error("the run was interrupted")]
    Interrupted,
    /// The world could not be built.
    #[cfg(feature = "sim")]
    #[error(transparent)]
    Mujoco(#[from] vibrissa_mujoco::MujocoError),
    /// The quasi-static world could not be built.
    #[error(transparent)]
    QuasiStatic(#[from] QuasiStaticError),
    /// The program was built without the world.
    #[error("this build has no world `{0}`; build the program with the feature `sim`, or use the world `quasistatic`")]
    NoWorld(WorldKind),
}

/// Builds a world of the true array of a scene. `seed` fixes the noise of sensors and poses.
///
/// # Errors
/// [`ExecuteError`] if the world refuses the scene.
pub(crate) fn build_world(scene: &Scene, world: WorldSetup, seed: u64) -> Result<Box<dyn World>, ExecuteError> {
    let Some(array) = scene.true_array() else {
        return simulator(scene, (&scene.rig, &scene.physics), world, seed);
    };
    let physics = array.physics(&scene.physics);
    if array.is_measured_exactly() {
        return simulator(scene, (&array.rig, &physics), world, seed);
    }
    let inner = simulator(scene, (&Disturbed::inner_rig(&array), &physics), world, seed)?;
    Ok(Box::new(Disturbed::new(inner, array, seed)))
}

/// Builds a simulator of a rig among the solids of a scene.
fn simulator(
    scene: &Scene,
    (rig, physics): (&Rig, &Physics),
    world: WorldSetup,
    seed: u64,
) -> Result<Box<dyn World>, ExecuteError> {
    let Scene { solids, start, .. } = scene;
    match world.kind {
        #[cfg(feature = "sim")]
        WorldKind::Mujoco => {
            let build = if world.prune { MujocoWorld::pruned } else { MujocoWorld::new };
            Ok(Box::new(build(rig, physics, solids, *start, seed)?))
        }
        #[cfg(not(feature = "sim"))]
        WorldKind::Mujoco => Err(ExecuteError::NoWorld(world.kind)),
        WorldKind::QuasiStatic => Ok(Box::new(QuasiStaticWorld::new(rig, physics, solids, *start, seed)?)),
    }
}

/// Checks that the world is available.
///
/// # Errors
/// [`ExecuteError`] if this build does not have it, or if the library of its simulator cannot be loaded.
pub fn check_world(kind: WorldKind) -> Result<(), ExecuteError> {
    match kind {
        #[cfg(feature = "sim")]
        WorldKind::Mujoco => {
            vibrissa_mujoco::engine_version().map(|_| ()).map_err(|cause| ExecuteError::Mujoco(cause.into()))
        }
        #[cfg(not(feature = "sim"))]
        WorldKind::Mujoco => Err(ExecuteError::NoWorld(kind)),
        WorldKind::QuasiStatic => Ok(()),
    }
}

/// The versions of this program and of its simulator.
#[must_use]
pub fn engine_version() -> String {
    format!("{} with {}", env!("CARGO_PKG_VERSION"), mujoco_version())
}

/// The version of a simulator. That of the quasi-static one is this program's.
#[must_use]
pub fn simulator_version(name: &str) -> &'static str {
    if name == WorldKind::QuasiStatic.name() { env!("CARGO_PKG_VERSION") } else { mujoco_version() }
}

/// The version of MuJoCo, if this build has it and its library can be loaded.
fn mujoco_version() -> &'static str {
    #[cfg(feature = "sim")]
    return vibrissa_mujoco::engine_version().unwrap_or("none");
    #[cfg(not(feature = "sim"))]
    return "none";
}

/// The MuJoCo model of the true array of a scene.
#[must_use]
pub fn model(scene: &Scene) -> String {
    let Scene { rig, physics, solids, start, .. } = scene;
    match scene.true_array() {
        Some(array) => mjcf(&array.rig, &array.physics(physics), solids, *start),
        None => mjcf(rig, physics, solids, *start),
    }
}

/// A hash of everything except scenario and policy that a run in a world depends on: the versions of this program and
/// of the simulator, the model, and the pruning.
#[must_use]
pub(super) fn engine_hash(scene: &Scene, world: WorldSetup) -> [u8; 32] {
    let engine = match world.kind {
        WorldKind::Mujoco => mujoco_version(),
        WorldKind::QuasiStatic => world.kind.name(),
    };
    let mut hash = Sha256::new();
    hash.update(env!("CARGO_PKG_VERSION"));
    hash.update([0]);
    hash.update(engine);
    hash.update([0]);
    // The model has the mechanics of the rig, the solids and the start, for every world. The values of the scenario that
    // are not in it are in the hash of the scenario, and their defaults change only with the version.
    hash.update(model(scene));
    hash.update([u8::from(world.prune)]);
    hash.update(scene.physics.calm_step.to_le_bytes());
    hash.finalize().into()
}
