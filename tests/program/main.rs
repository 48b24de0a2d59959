//! The program as its users meet it: commands, the language server, policies at work.
#![allow(clippy::unwrap_used, reason = "a test may panic")]
#![allow(clippy::disallowed_methods, reason = "a test may open files")]

mod cli;
#[cfg(feature = "sim")]
mod disk;
#[cfg(target_os = "linux")]
mod faults;
#[cfg(feature = "lsp")]
mod lsp;
#[cfg(feature = "sim")]
mod policies;
mod tutorial;
#[cfg(feature = "sim")]
mod watch;
#[cfg(feature = "sim")]
mod worlds;
