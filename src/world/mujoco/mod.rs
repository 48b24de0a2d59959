//! The MuJoCo world.

mod engine;
mod library;
mod lookout;
mod messages;
mod plugin;
mod pruner;
mod world;

pub use library::LibraryError;
pub use messages::engine_version;
pub use plugin::PluginError;
pub use world::{MujocoError, MujocoWorld};
