//! Comparison of simulations: the same policy in the same scenes.

mod compare;
mod row;
mod simulation;
mod track;

pub use compare::compare_worlds;
pub use row::{Differences, WorldsRow};
pub use simulation::Simulation;
