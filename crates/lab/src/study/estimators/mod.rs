//! Comparison of contact estimators on the same samples, at several levels of noise.

mod evaluation;
mod row;

pub(super) use evaluation::evaluate;
pub use evaluation::evaluate_all;
pub use row::EstimatorRow;
