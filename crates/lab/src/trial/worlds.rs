//! The simulator of a run, and all that its figures depend on.

use sha2::{Digest, Sha256};
use vibrissa_mujoco::mjcf;
use vibrissa_runtime::control::BindError;
use vibrissa_runtime::rig::Rig;
use vibrissa_world::geometry::{Piece, Point2};
use vibrissa_world::physics::Physics;
use vibrissa_world::scene::{Scene, WorldKind, WorldSetup};
use vibrissa_world::solid::{PartsError, Solid};
use vibrissa_world::world::{Disturbed, Pruning, World};

use super::simulators::{Simulator, SimulatorError, Surroundings};

/// The error of a run that cannot begin.
#[derive(Debug, thiserror::Error)]
pub enum ExecuteError {
    /// The scenario's rig does not have what the policy needs.
    #[error(transparent)]
    Bind(#[from] BindError),
    /// The run ends with a map that the policy does not have.
    #[error(
        "the scenario has `stop: {{mapped: true}}`, but the policy `{policy}` has no map; use a policy that reads `map`, or end the run by `loop_closed` or `succeeded`"
    )]
    NoMap {
        /// Name of the policy.
        policy: String,
    },
    /// The run was stopped.
    #[error("the run was interrupted")]
    Interrupted,
    /// The simulator is not there, or it refuses the scene.
    #[error(transparent)]
    Simulator(#[from] SimulatorError),
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
    let surroundings = Surroundings { rig, physics, solids: &scene.solids, start: scene.start };
    Ok((Simulator::of(world.kind).build)(&surroundings, world.prune, seed)?)
}

/// Checks that the simulator is available.
///
/// # Errors
/// [`ExecuteError`] if this build does not have it, or if its library cannot be loaded.
pub fn check_world(kind: WorldKind) -> Result<(), ExecuteError> {
    Ok((Simulator::of(kind).check)()?)
}

/// What a run of a rig in a scene omits, under a policy that binds the whiskers with the names `bound`.
///
/// # Errors
/// [`ExecuteError`] if the simulator refuses the scene.
pub fn pruning(
    scene: &Scene,
    rig: &Rig,
    physics: &Physics,
    bound: &[String],
    kind: WorldKind,
) -> Result<Pruning, ExecuteError> {
    let surroundings = Surroundings { rig, physics, solids: &scene.solids, start: scene.start };
    Ok(Pruning::new((Simulator::of(kind).decisions)(&surroundings)?, rig, bound))
}

/// The versions of this program and of its simulator.
#[must_use]
pub fn engine_version() -> String {
    format!("{} with {}", env!("CARGO_PKG_VERSION"), mujoco_version())
}

/// The version of the simulator with this name. A simulator without a library has that of this program.
#[must_use]
pub fn simulator_version(name: &str) -> &'static str {
    let known = WorldKind::named(name);
    known.map_or(env!("CARGO_PKG_VERSION"), |kind| (Simulator::of(kind).version)().unwrap_or(env!("CARGO_PKG_VERSION")))
}

/// The version of MuJoCo, if this build has it and its library can be loaded.
fn mujoco_version() -> &'static str {
    (Simulator::of(WorldKind::Mujoco).version)().unwrap_or_default()
}

/// The MuJoCo model of the true array of a scene.
///
/// # Errors
/// [`PartsError`] if a solid is too large for MuJoCo.
pub fn model(scene: &Scene) -> Result<String, PartsError> {
    model_among(scene, &scene.solids)
}

/// The MuJoCo model of the true array of a scene among these solids.
fn model_among(scene: &Scene, solids: &[Solid]) -> Result<String, PartsError> {
    let Scene { rig, physics, start, .. } = scene;
    match scene.true_array() {
        Some(array) => mjcf(&array.rig, &array.physics(physics), solids, *start),
        None => mjcf(rig, physics, solids, *start),
    }
}

/// A hash of everything except scenario and policy that a run in a world depends on: the versions of this program and
/// of the simulator, the model or the surfaces, and the pruning.
#[must_use]
pub(super) fn engine_hash(scene: &Scene, world: WorldSetup) -> [u8; 32] {
    let engine = (Simulator::of(world.kind).version)().unwrap_or(world.kind.name());
    let mut hash = Sha256::new();
    hash.update(env!("CARGO_PKG_VERSION"));
    hash.update([0]);
    hash.update(engine);
    hash.update([0]);
    // A scene that MuJoCo refuses is identified by the reason.
    let text = |model: Result<String, PartsError>| model.unwrap_or_else(|refused| refused.to_string());
    // The model has the mechanics of the rig, the solids and the start. The values of the scenario that are not in it are
    // in the hash of the scenario, and their defaults change only with the version.
    match world.kind {
        WorldKind::Mujoco => hash.update(text(model(scene))),
        // It simulates the surfaces, not the convex parts of the model.
        WorldKind::QuasiStatic => {
            hash.update(text(model_among(scene, &[])));
            for piece in scene.solids.iter().flat_map(|solid| solid.surface().pieces()) {
                let [Point2 { coords: a }, Point2 { coords: b }] = [piece.start(), piece.end()];
                let shape = if let Piece::Arc(arc) = piece { [arc.radius, arc.sweep] } else { [0.0; 2] };
                for number in [a.x, a.y, b.x, b.y].into_iter().chain(shape) {
                    hash.update(number.to_le_bytes());
                }
            }
        }
    }
    hash.update([u8::from(world.prune)]);
    hash.update(scene.physics.calm_step.to_le_bytes());
    hash.finalize().into()
}
