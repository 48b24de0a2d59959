//! Texts of users: errors with their positions, and files.
//!
//! - [`diagnostic`] has one type for errors and warnings in texts, and its renderings.
//! - [`mod@file`] opens every file: it refuses what would block, bounds what is read, and replaces a file as a whole or not at all.

pub mod diagnostic;
#[cfg(feature = "files")]
pub mod file;
