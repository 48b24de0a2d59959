//! From contact to command: mechanics, readings, perception, steering, worlds.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

#[path = "../common/mod.rs"]
mod common;
mod elastica;
#[cfg(feature = "sim")]
mod friction;
mod gaps;
mod perception;
mod quasi_static;
mod sliding;
mod steering;
mod tip_model;
#[cfg(feature = "sim")]
mod world;
