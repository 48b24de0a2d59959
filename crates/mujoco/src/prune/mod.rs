//! Pruning: the omission of parts of a model that cannot affect the run.

mod pruning;
mod reach;
mod scope;

pub use pruning::{Decision, Pruning, Verdict};
pub use reach::{Reach, is_gentle, may_be_rigid};
pub use scope::Scope;
