//! How fast the runs of the bench are.

use serde::Serialize;

use crate::results::Document;
use crate::scene::Outcome;
use crate::score::Statistics;
use crate::trial::{ExecuteError, Trial, TrialResult, processor_time};

/// How fast one run was.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Timing {
    /// How it ended.
    pub outcome: Outcome,
    /// Simulated time (s).
    pub sim: f64,
    /// Wall time (s) from the compiled policy and the scene to the end of the first tick: world, tables of perception.
    pub start: f64,
    /// Time of the processor (s): world, perception, policy, and score.
    pub processor: f64,
    /// Mean time of a control tick (s), if there was one.
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
        let TrialResult { run, score, .. } = trial.run()?;
        let processor = processor_time() - start;
        Ok(Self {
            outcome: run.outcome,
            sim: run.trace.ticks.last().map_or(0.0, |tick| tick.time),
            start: run.start.as_secs_f64(),
            processor,
            tick_mean: score.latency.map(|latency| latency.mean),
            tick_p99: score.latency.map(|latency| latency.p99),
        })
    }
}

/// How fast a scene is under a policy: medians over several runs of it.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct TimingRow {
    /// The scenario, with what makes it harder.
    pub scenario: String,
    /// The policy.
    pub policy: String,
    /// The world.
    pub world: String,
    /// How the runs ended.
    pub outcome: Outcome,
    /// How many there were.
    pub runs: usize,
    /// Simulated time.
    pub sim_s: f64,
    /// Wall time from the compiled policy and the scene to the end of the first tick.
    pub start_ms: f64,
    /// Time of the processor: world, perception, policy, and score.
    pub processor_s: f64,
    /// Simulated time over time of the processor.
    pub realtime: f64,
    /// The least and the greatest of these.
    pub realtime_range: [f64; 2],
    /// Time of a control tick.
    pub tick_us: TickTimes,
}

impl Document for TimingRow {
    const FORMAT: &'static str = "timing";
}

/// Time of a control tick (µs): perception, policy, and steering.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct TickTimes {
    /// The median of the runs' means.
    pub mean: Option<f64>,
    /// The median of their 99th percentiles.
    pub p99: Option<f64>,
}

impl TimingRow {
    /// The row of a scene's runs; `None` if there are none.
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
