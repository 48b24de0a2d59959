//! Whole random programs mean in a machine what they mean to a plain interpreter.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

#[path = "../common/mod.rs"]
mod common;

mod evaluate;
mod filter;
mod generate;
mod grow;
mod interpreter;
mod side_by_side;
mod text;
mod tree;
