//! The statics of a whisker: its shaft as the exact elastica, and as the chain of links that the simulator holds.

mod bend;
mod chain;
mod elastica;
mod extrapolation;
mod follow;
mod newton;
mod shot;

pub use bend::Bend;
pub use chain::{Equilibrium, ShaftChain};
pub use elastica::Elastica;
