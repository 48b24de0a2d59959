//! The bench: the baseline's scenes under its policy and others, compared with the baseline's results.

mod conditions;
mod row;
mod thesis;

pub use conditions::Conditions;
pub use row::{BenchRow, Verdict, Verdicts};
pub use thesis::{Reported, THESIS, ThesisFigures};
