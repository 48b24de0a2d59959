//! Pruning: the omission of parts of a model that cannot affect the run.
//!
//! Why: docs/decisions/mujoco-speed.md#pruning-is-exact-or-it-is-a-setting.

mod pruning;
mod reach;
mod scope;

pub use pruning::{Decision, Pruning, Verdict};
pub use reach::{Reach, is_gentle, may_be_rigid};
pub use scope::Scope;
