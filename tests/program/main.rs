//! The program as its users meet it: commands, the language server, policies at work.
#![allow(clippy::unwrap_used, reason = "a test may panic")]
#![allow(clippy::disallowed_methods, reason = "a test may open files")]

mod command;
#[cfg(unix)]
mod deployment;
#[cfg(feature = "sim")]
mod disk;
#[cfg(feature = "lsp")]
mod editor;
#[cfg(target_os = "linux")]
mod faults;
mod kept_scenes;
#[cfg(feature = "live")]
mod live;
#[cfg(feature = "sim")]
mod metrics;
#[cfg(feature = "sim")]
mod policies;
#[path = "../common/snapshots.rs"]
mod snapshots;
#[cfg(feature = "sim")]
mod thesis_array;
mod tutorial;
#[cfg(feature = "sim")]
mod worlds;
