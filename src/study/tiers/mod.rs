//! Tiers of worlds against each other: the same policy, the same scenes.

mod compare;
mod row;
mod tier;
mod track;

pub use compare::compare_tiers;
pub use row::{Apart, TierRow, tiers_table};
pub use tier::Tier;
