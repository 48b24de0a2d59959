//! Latency of the control loop in the phases of a policy.

use std::time::Duration;

use crate::run::{Run, TickRecord, Trace};
use crate::score::Statistics;

/// The name of the phase after a failure of the policy, as in [`crate::score::state_shares`].
const FAILURE: &str = "Failure";

/// Times of control ticks in one phase of a policy in one scene. A tick is perception, machine and motion. A phase is an
/// outermost state of the policy, and a tick belongs to the phase that it ends in.
///
/// The run is repeated with the same ticks. The time of a tick is the median of its repetitions, so that an interruption by
/// another program does not count.
#[derive(Debug, Clone, PartialEq)]
pub struct LatencyRow {
    /// The scenario.
    pub scenario: String,
    /// The policy.
    pub policy: String,
    /// Name of the outermost state.
    pub phase: String,
    /// Number of ticks of a run.
    pub ticks: usize,
    /// Median of their times (s).
    pub median: f64,
    /// 99th percentile (s), by [`Statistics::percentile`].
    pub p99: f64,
    /// Longest time of a tick (s).
    pub worst: f64,
    /// Ratio of that time to the control period. Above 1, the tick is always late.
    pub share: f64,
    /// Longest time of a single repetition (s), with interruptions.
    pub longest: f64,
}

impl LatencyRow {
    /// A row for each phase with ticks, in the order of the policy. The `runs` are repetitions of the same run.
    #[must_use]
    pub fn of(scenario: &str, policy: &str, runs: &[Run]) -> Vec<Self> {
        let Some(Run { trace, .. }) = runs.first() else { return Vec::new() };
        let repetitions = |tick| runs.iter().filter_map(move |run| run.tick_times.get(tick));
        let ticks: Vec<_> = (trace.ticks.iter().enumerate())
            .filter_map(|(index, tick)| {
                let times = Statistics::of(repetitions(index).map(Duration::as_secs_f64).collect())?;
                Some((outermost(trace, tick), times))
            })
            .collect();
        let phases = trace.states.iter().enumerate().map(|(state, name)| (Some(state), name.as_str()));
        let rows = phases.chain([(None, FAILURE)]).filter_map(|(phase, name)| {
            let within = || ticks.iter().filter(|(of, _)| *of == phase).map(|(_, times)| times);
            let times = Statistics::of(within().map(|times| times.percentile(50.0)).collect())?;
            Some(Self {
                scenario: scenario.to_owned(),
                policy: policy.to_owned(),
                phase: name.to_owned(),
                ticks: times.count(),
                median: times.percentile(50.0),
                p99: times.percentile(99.0),
                worst: times.max(),
                share: times.max() / trace.period,
                longest: within().map(Statistics::max).fold(0.0, f64::max),
            })
        });
        rows.collect()
    }
}

/// The outermost active state after a tick. `None` after a failure.
fn outermost(trace: &Trace, tick: &TickRecord) -> Option<usize> {
    std::iter::successors(tick.state, |&state| trace.parents.get(state).copied().flatten()).last()
}
