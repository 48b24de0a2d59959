//! The YAML format of scenarios.

mod errors;
mod near;
mod page;
mod scenes;
