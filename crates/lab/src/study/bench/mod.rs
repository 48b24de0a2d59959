//! The bench: the baseline's scenes under its policy and others, compared with the baseline's results.

mod baseline;
mod conditions;
mod row;

pub use baseline::{BASELINE, BaselineFigures, Reported};
pub use conditions::Conditions;
pub use row::{BenchRow, Verdict, Verdicts};
