//! The quasi-static world: what it reads is what a whisker in balance gives that enters nothing.

mod balance;
mod body;
mod crowded;
mod friction;
mod minimum;
pub(crate) mod scene;
mod world;
