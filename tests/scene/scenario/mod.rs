//! The YAML format of scenarios.

mod corners;
mod errors;
mod near;
mod page;
mod scenes;
