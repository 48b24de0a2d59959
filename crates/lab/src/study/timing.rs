//! Run times of the bench.

use serde::Serialize;

use crate::results::{Document, Ending};
use crate::score::Statistics;
use crate::trial::{ExecuteError, Trial, TrialResult, processor_time};

/// Run time of one run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Timing {
    /// Outcome of the run.
    pub outcome: Ending,
    /// Simulated time (s).
    pub sim: f64,
    /// Wall time (s) from the compiled policy and the scene to the end of the first tick. It includes the world and the
    /// tables of perception.
    pub start: f64,
    /// Processor time (s) of world, perception, policy and score.
    pub processor: f64,
    /// Mean time of a control tick (s). `None` without a tick.
    pub tick_mean: Option<f64>,
    /// Its 99th percentile (s).
    pub tick_p99: Option<f64>,
}

impl Timing {
    /// Runs and scores a trial once.
    ///
    /// # Errors
    /// [`ExecuteError`] if the run cannot begin.
    pub fn take(trial: &Trial) -> Result<Self, ExecuteError> {
        let start = processor_time();
        let result = trial.run()?;
        let processor = processor_time() - start;
        let TrialResult { run, score, .. } = &result;
        Ok(Self {
            outcome: result.ending(),
            sim: run.trace.ticks.last().map_or(0.0, |tick| tick.time),
            start: run.start.as_secs_f64(),
            processor,
            tick_mean: score.latency.as_ref().map(|latency| latency.mean),
            tick_p99: score.latency.as_ref().map(|latency| latency.p99),
        })
    }
}

/// Run time of a scene under a policy: medians over several runs.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct TimingRow {
    /// The scenario followed by the conditions.
    pub scenario: String,
    /// The policy.
    pub policy: String,
    /// The world.
    pub world: String,
    /// Outcome of the runs.
    pub outcome: Ending,
    /// Number of runs.
    pub runs: usize,
    /// Simulated time.
    pub sim_s: f64,
    /// Wall time from the compiled policy and the scene to the end of the first tick.
    pub start_ms: f64,
    /// Processor time of world, perception, policy and score.
    pub processor_s: f64,
    /// Ratio of simulated time to processor time.
    pub realtime: f64,
    /// The smallest and the largest of these ratios.
    pub realtime_range: [f64; 2],
    /// Time of a control tick.
    pub tick_us: TickTimes,
}

impl Document for TimingRow {
    const FORMAT: &'static str = "timing";
    // A run that met its stop condition but not all expectations was `completed`.
    const VERSION: u32 = 2;
}

/// Time of a control tick (µs): perception, policy and motion.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct TickTimes {
    /// The median of the runs' means.
    pub mean: Option<f64>,
    /// The median of their 99th percentiles.
    pub p99: Option<f64>,
}

impl TimingRow {
    /// The row of a scene's runs. `None` without a run.
    #[must_use]
    pub fn new(scenario: String, policy: String, world: String, runs: &[Timing]) -> Option<Self> {
        let first = runs.first()?;
        let statistics =
            |figure: &dyn Fn(&Timing) -> Option<f64>| Statistics::of(runs.iter().filter_map(figure).collect());
        let median = |statistics: Statistics| statistics.percentile(50.0);
        let realtime = statistics(&|run| Some(run.sim / run.processor))?;
        Some(Self {
            scenario,
            policy,
            world,
            outcome: first.outcome,
            runs: runs.len(),
            sim_s: first.sim,
            start_ms: 1e3 * median(statistics(&|run| Some(run.start))?),
            processor_s: median(statistics(&|run| Some(run.processor))?),
            realtime: realtime.percentile(50.0),
            realtime_range: [realtime.percentile(0.0), realtime.max()],
            tick_us: TickTimes {
                mean: statistics(&|run| run.tick_mean).map(|mean| 1e6 * median(mean)),
                p99: statistics(&|run| run.tick_p99).map(|p99| 1e6 * median(p99)),
            },
        })
    }
}
