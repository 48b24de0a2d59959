//! Tables, pages and pictures of results, and statecharts of policies.

mod chart;
mod number;
mod outline;
mod page;
mod picture;
mod shade;
mod style;
mod table;
mod tables;

pub use chart::{ChartTooLarge, chart_dot, chart_mermaid, chart_svg};
pub use page::{RunFigures, bench_page, comparison_page, pareto_page, runs_page};
pub use page::{families_page, sweep_page};
pub use picture::profile_picture;
pub use picture::{frame, growth_picture, pareto_picture, picture, retrieval_picture};
pub use style::WHISKERS;
pub use table::Table;
pub use tables::{
    bench_table, comparison_tables, difference_tables, estimators_tables, latency_table, near_miss_table, pareto_table,
    pooled_tips, results_table, scale_tables, stop_tables, stress_tables, timing_table, worlds_table,
};
pub use tables::{families_table, held_out_table, measured_table, summary_table, tuning_tables};
#[cfg(feature = "robot")]
pub use tables::{faults_table, replay_tables};
