//! How fast the runs of the bench are.

use crate::report::Document;
use std::ops::ControlFlow;
use std::sync::Arc;

use serde::Serialize;

use crate::report::{NONE, Table};
use crate::scene::{Outcome, Scene, WorldSetup};
use crate::score::{Score, Statistics};
use crate::study::processor_time::processor_time;
use crate::study::{ExecuteError, execute};
use vibrissa_runtime::machine::Program;

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
    /// Runs `program` in `scene` once, and scores that.
    ///
    /// # Errors
    /// [`ExecuteError`] when the run cannot begin.
    pub fn take(scene: &Scene, program: &Arc<Program>, world: WorldSetup, seed: u64) -> Result<Self, ExecuteError> {
        let start = processor_time();
        let run = execute(scene, Arc::clone(program), world, seed, |_| ControlFlow::Continue(()))?;
        let score = Score::new(&run, &scene.truth, &scene.rig);
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

/// A table with a row for every scene and policy: simulated time over processor time (median, least, greatest), and the times of a control tick.
#[must_use]
pub fn timing_table(rows: &[TimingRow]) -> Table {
    let headings = [
        "scene",
        "policy",
        "world",
        "outcome",
        "× real time",
        "tick µs",
        "processor s",
        "start ms",
        "sim s",
        "p99 tick µs",
        "least × real time",
        "greatest × real time",
    ];
    let microseconds = |time: Option<f64>| time.map_or_else(|| NONE.to_owned(), |time| format!("{time:.1}"));
    let cells = |row: &TimingRow| {
        vec![
            row.scenario.clone(),
            row.policy.clone(),
            row.world.clone(),
            row.outcome.to_string(),
            format!("{:.0}", row.realtime),
            microseconds(row.tick_us.mean),
            format!("{:.3}", row.processor_s),
            format!("{:.1}", row.start_ms),
            format!("{:.1}", row.sim_s),
            microseconds(row.tick_us.p99),
            format!("{:.0}", row.realtime_range[0]),
            format!("{:.0}", row.realtime_range[1]),
        ]
    };
    Table::new(4, headings, rows.iter().map(cells))
}
