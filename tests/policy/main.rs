//! The policy language: what it means, what it answers, what is made of it.
#![allow(clippy::unwrap_used, reason = "a test may panic")]
#![allow(clippy::disallowed_methods, reason = "a test may open files")]

mod codes;
#[path = "../common/mod.rs"]
mod common;
mod editors;
mod errors;
mod expressions;
mod format;
mod index;
mod machine;
mod names;
mod page;
mod programs;
mod recovery;
mod shorter_code;
#[path = "../common/snapshots.rs"]
mod snapshots;
mod standard_library;
mod test_blocks;
mod use_files;
mod warnings;
