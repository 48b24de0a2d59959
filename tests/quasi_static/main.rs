//! The quasi-static world: what it reads is what a whisker in balance gives that enters nothing.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

mod balance;
mod body;
mod minimum;
mod scene;
mod world;
