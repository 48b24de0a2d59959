//! The MuJoCo simulator: its model of a scene, the pruning of the model, and the world.
//!
//! The model and the pruning do not need the library. The world requires the feature `sim`.
//!
//! # Where to begin
//!
//! `mjcf.rs` writes the model. `prune` decides what of a scene is simulated, and its tests compare with the whole scene. Read
//! `docs/decisions/mujoco.md` and `docs/decisions/mujoco-speed.md` before you change a step or a tolerance.

#[cfg(feature = "sim")]
mod broad_phase;
mod contacts;
#[cfg(feature = "sim")]
mod engine;
#[cfg(feature = "sim")]
mod library;
#[cfg(feature = "sim")]
mod link;
#[cfg(feature = "sim")]
mod messages;
mod mjcf;
#[cfg(feature = "sim")]
mod model_selector;
#[cfg(feature = "sim")]
mod plugin;
mod prune;
#[cfg(feature = "sim")]
pub mod visual;
#[cfg(feature = "sim")]
mod world;

#[cfg(feature = "sim")]
pub use library::{LibraryError, LibrarySet, set_library};
#[cfg(feature = "sim")]
pub use messages::engine_version;
pub use mjcf::mjcf;
#[cfg(feature = "sim")]
pub(crate) use mjcf::{mjcf_within, part_names};
#[cfg(feature = "sim")]
pub use plugin::PluginError;
pub use prune::{Reach, Scope, decisions, is_gentle, may_be_rigid};
#[cfg(feature = "sim")]
pub use world::{MujocoError, MujocoWorld};
