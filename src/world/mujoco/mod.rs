//! The MuJoCo world.

mod engine;
mod lookout;
mod messages;
mod plugin;
mod pruner;
mod world;

pub use messages::engine_version;
pub use plugin::PluginError;
pub use world::{MujocoError, MujocoWorld};
