//! Tables of results and studies.

pub(super) mod bench;
mod calibration;
pub(super) mod comparison;
mod estimators;
mod families;
#[cfg(feature = "robot")]
mod faults;
mod latency;
mod near_misses;
mod pareto;
#[cfg(feature = "robot")]
mod replay;
pub(super) mod results;
mod scale;
mod stop;
mod stress;
mod sweep;
mod tally;
mod timing;
mod tuning;
mod worlds;

pub use bench::{bench_table, pooled_tips};
pub use calibration::{held_out_table, measured_table};
pub use comparison::comparison_tables;
pub use estimators::estimators_tables;
pub use families::families_table;
#[cfg(feature = "robot")]
pub use faults::faults_table;
pub use latency::latency_table;
pub use near_misses::near_miss_table;
pub use pareto::pareto_table;
#[cfg(feature = "robot")]
pub use replay::replay_tables;
pub use results::results_table;
pub use scale::scale_tables;
pub use stop::{difference_tables, stop_tables};
pub use stress::stress_tables;
pub use sweep::summary_table;
pub use timing::timing_table;
pub use tuning::tuning_tables;
pub use worlds::worlds_table;
