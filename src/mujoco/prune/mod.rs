//! Pruning: what of a scene a model need not hold, because it cannot matter.

mod pruning;
mod reach;
mod scope;

pub use pruning::{Decision, Pruning, Verdict};
pub use reach::{Reach, is_gentle, may_be_rigid};
pub use scope::Scope;
