//! States in states: what they mean, by example and against an interpreter of their own.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

#[path = "../common/mod.rs"]
mod common;

mod claims;
mod cycles;
mod interpreter;
mod oracle;
mod tree;
