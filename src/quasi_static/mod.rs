//! The quasi-static world: whiskers in static equilibrium at every sample, against exact outlines.

mod balance;
mod bordered;
mod carriage;
mod hull;
mod lag;
mod surface;
mod touch;
mod whisker;
mod wire;
mod world;

pub use world::{QuasiStaticError, QuasiStaticWorld};
