//! The YAML format of scenarios.

mod corners;
mod errors;
mod mismatch;
mod near;
mod page;
mod rig_keys;
mod scenes;
mod zoo;
