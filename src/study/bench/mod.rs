//! The bench: the thesis's scenes under its policy and others, beside what the thesis reports.

mod conditions;
mod row;
mod thesis;

pub use conditions::Conditions;
pub use row::{BenchRow, Verdict, Verdicts};
pub use thesis::{Reported, THESIS, ThesisFigures, thesis_figures};
