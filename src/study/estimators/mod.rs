//! Tip models against each other: the same samples for all of them, with more and more noise.

mod judge;
mod row;
mod tape;

pub(super) use judge::judge;
pub use judge::judge_all;
pub use row::{EstimatorRow, estimators_tables};
pub(super) use tape::Tape;
