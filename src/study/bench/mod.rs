//! The bench: the thesis's scenes under its policy and others, beside what the thesis reports.

mod built_in;
mod conditions;
mod page;
mod row;
mod table;
mod thesis;
mod timing;

pub use built_in::{DEFAULT_POLICY, POLICIES, SCENARIOS, TextFile};
pub use conditions::Conditions;
pub use page::bench_page;
pub use row::{BenchRow, Verdict, Verdicts};
pub use table::{bench_table, pooled_tips};
pub use thesis::{Reported, THESIS, ThesisFigures, thesis_figures};
pub use timing::{TickTimes, Timing, TimingRow, timing_table};
