//! The statics of a whisker: its shaft as the exact elastica, and as the chain of links that the simulator holds; where it is
//! touched, from what its base feels.

mod bend;
mod chain;
mod elastica;
mod extrapolation;
mod follow;
mod locate;
mod newton;
mod pivot;
mod shot;
mod touch;

pub use bend::Bend;
pub use chain::Sought;
pub use chain::{Equilibrium, ShaftChain};
pub use elastica::Elastica;
pub use locate::LocateError;
pub use pivot::Pivot;
