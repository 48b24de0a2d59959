//! From contact to command: mechanics, readings, perception, steering, worlds.
#![allow(clippy::unwrap_used, reason = "a test may panic")]
#![allow(clippy::disallowed_methods, reason = "a test may open files")]

mod blocked;
#[cfg(feature = "sim")]
mod cable;
mod calibration;
#[path = "../common/mod.rs"]
mod common;
mod contact_estimators;
mod elastica;
mod fitted;
#[cfg(feature = "sim")]
mod friction;
mod gaps;
mod moment_and_shear;
mod perception;
mod pose_hold;
mod quasi_static;
mod sliding;
#[cfg(feature = "sim")]
mod stability;
mod steering;
mod tip_curve;
#[cfg(feature = "sim")]
mod world;
