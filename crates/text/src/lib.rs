//! Texts of users: errors with their positions, and files.
//!
//! - [`diagnostic`] has one type for errors and warnings in texts, and its renderings.
//! - [`system`] words errors of the operating system.
//! - [`mod@file`] opens every file: it refuses what would block, bounds what is read, and replaces a file as a whole or not at all.
//!
//! # Where to begin
//!
//! A new rendering of diagnostics is a file beside the others in `diagnostic`. Every crate reads and writes files through `file`, whose
//! tests kill it at each system call, so a change there needs one more of them.

pub mod diagnostic;
#[cfg(feature = "files")]
pub mod file;
pub mod system;
