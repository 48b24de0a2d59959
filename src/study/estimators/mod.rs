//! Tip models against each other: the same samples for all of them, with more and more noise.

mod evaluation;
mod row;

pub(super) use evaluation::evaluate;
pub use evaluation::evaluate_all;
pub use row::EstimatorRow;
