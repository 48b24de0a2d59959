//! The processor time of control ticks.

use std::time::Duration;

use super::Statistics;

/// Processor time of the thread in a run's control ticks (s).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Latency {
    /// Mean.
    pub mean: f64,
    /// 99th percentile, by [`Statistics::percentile`].
    pub p99: f64,
    /// Maximum.
    pub max: f64,
}

impl Latency {
    /// The figures of ticks with these `times`. `None` without ticks.
    #[must_use]
    pub fn of(times: &[Duration]) -> Option<Self> {
        let statistics = Statistics::of(times.iter().map(Duration::as_secs_f64).collect())?;
        Some(Self { mean: statistics.mean(), p99: statistics.percentile(99.0), max: statistics.max() })
    }
}
