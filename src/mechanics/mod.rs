//! The statics of a whisker: its shaft as a chain of links, as the simulator holds it.

mod chain;

pub use chain::{Equilibrium, ShaftChain};
