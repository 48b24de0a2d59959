//! The result of a run, as programs read it.

use serde::{Serialize, Serializer};

use crate::run::{Run, Trace};
use crate::scene::Outcome;
use crate::score::{RetrievalFigures, Score, Spread};

/// The result of a run, in the units that its keys name; serialised, it is what `run --json` prints.
///
/// Every key is always there, with `null` for a figure that the run does not have. Numbers keep their full precision, so
/// that results can be compared bit for bit.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct RunResult {
    /// Name of the scenario.
    pub scenario: String,
    /// Name of the policy.
    pub policy: String,
    /// Name of the world.
    pub world: String,
    /// Seed of the sensor noise.
    pub seed: u64,
    /// How the run ended.
    pub outcome: Outcome,
    /// Why, if not as it should.
    pub reason: Option<String>,
    /// Name of the state that it ended in.
    pub final_state: String,
    /// Simulated time.
    pub sim_s: f64,
    /// Wall time of the loop alone.
    pub wall_s: f64,
    /// Simulated time over wall time; `None` if the clock saw none pass.
    pub realtime: Option<f64>,
    /// Distance of the tip estimates from the nearest surface.
    pub error_mm: ErrorMm,
    /// Share of the reference that was traced, 0 to 1.
    pub coverage: f64,
    /// Symmetric Hausdorff distance between the estimated contour and the reference.
    pub hausdorff_mm: Option<f64>,
    /// The states that were left by their failsafe.
    pub failsafes: Failsafes,
    /// The retrievals of whiskers that had lost the object; `None` if the policy made no marks.
    pub retrieval: Option<Retrieval>,
    /// Distance of the midpoints between two whiskers' tips from the axis of a tunnel; `None` outside of one.
    pub axis_mm: Option<MeanStd>,
    /// Wall time of a control tick.
    pub tick_us: TickUs,
    /// What the run depends on.
    pub hash: Hashes,
}

/// Which run a result is of.
#[derive(Debug, Clone, PartialEq)]
pub struct Identity {
    /// Name of the scenario.
    pub scenario: String,
    /// Name of the policy.
    pub policy: String,
    /// Name of the world.
    pub world: String,
    /// Seed of the sensor noise.
    pub seed: u64,
    /// What the run depends on.
    pub hash: Hashes,
}

/// Hashes of all that a run depends on: two runs with the same hashes and seed are the same run.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Hashes {
    /// Of the scenario.
    pub scenario: String,
    /// Of the policy with its parameters.
    pub policy: String,
    /// Of the program and the simulator.
    pub engine: String,
}

/// Distance of the tip estimates from the nearest surface (mm).
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ErrorMm {
    /// Mean.
    pub mean: Option<f64>,
    /// Sample standard deviation.
    pub std: Option<f64>,
    /// 95th percentile.
    pub p95: Option<f64>,
    /// Maximum.
    pub max: Option<f64>,
    /// Number of estimates.
    pub n: usize,
}

/// States that were left by their failsafe.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct Failsafes {
    /// How many times one was.
    pub count: usize,
    /// When the first was.
    pub first_s: Option<f64>,
    /// Name of the state that was left then.
    pub first_state: Option<String>,
    /// Why it was left.
    pub first_cause: Option<String>,
}

/// Retrievals of whiskers that had lost the object, by the thesis's definitions (section 5.2).
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Retrieval {
    /// How many there were.
    pub count: usize,
    /// Distance from the edge point, the last tip recorded before contact was lost, to where it was found again.
    pub radius_mm: MeanStd,
    /// Length of the path of the platform's centre of mass between the two.
    pub distance_mm: MeanStd,
    /// Time between the two.
    pub time_s: MeanStd,
}

/// Mean and sample standard deviation, in the unit of the key that holds them.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct MeanStd {
    /// Mean.
    pub mean: Option<f64>,
    /// Sample standard deviation.
    pub std: Option<f64>,
}

/// Wall time of a control tick (µs).
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct TickUs {
    /// Mean.
    pub mean: Option<f64>,
    /// 99th percentile.
    pub p99: Option<f64>,
    /// Maximum.
    pub max: Option<f64>,
}

impl RunResult {
    /// The result of `run`, which got this `score`.
    #[must_use]
    pub fn new(identity: Identity, run: &Run, score: &Score) -> Self {
        let Identity { scenario, policy, world, seed, hash } = identity;
        let millimetres = |metres: f64| metres * 1e3;
        let microseconds = |seconds: f64| seconds * 1e6;
        let (error, latency) = (score.error, score.latency);
        let sim_s = run.trace.ticks.last().map_or(0.0, |tick| tick.time);
        let wall_s = run.wall.as_secs_f64();
        Self {
            scenario,
            policy,
            world,
            seed,
            outcome: run.outcome,
            reason: run.reason.clone(),
            final_state: run.final_state.clone(),
            sim_s,
            wall_s,
            realtime: (wall_s > 0.0).then(|| sim_s / wall_s),
            error_mm: ErrorMm {
                mean: error.map(|error| millimetres(error.mean)),
                std: error.and_then(|error| error.std).map(millimetres),
                p95: error.map(|error| millimetres(error.p95)),
                max: error.map(|error| millimetres(error.max)),
                n: error.map_or(0, |error| error.count),
            },
            coverage: score.coverage,
            hausdorff_mm: score.hausdorff.map(millimetres),
            failsafes: failsafes(&run.trace),
            retrieval: score.retrieval.as_ref().map(Retrieval::new),
            axis_mm: score.axis.map(|axis| MeanStd::new(Some(axis), 1e3)),
            tick_us: TickUs {
                mean: latency.map(|latency| microseconds(latency.mean)),
                p99: latency.map(|latency| microseconds(latency.p99)),
                max: latency.map(|latency| microseconds(latency.max)),
            },
            hash,
        }
    }
}

impl Retrieval {
    fn new(figures: &RetrievalFigures) -> Self {
        Self {
            count: figures.count,
            radius_mm: MeanStd::new(figures.radius, 1e3),
            distance_mm: MeanStd::new(figures.distance, 1e3),
            time_s: MeanStd::new(figures.time, 1.0),
        }
    }
}

impl MeanStd {
    /// A spread (SI) in a unit of which there are `units` in the SI's.
    fn new(spread: Option<Spread>, units: f64) -> Self {
        Self {
            mean: spread.map(|spread| spread.mean * units),
            std: spread.and_then(|spread| spread.std).map(|std| std * units),
        }
    }
}

fn failsafes(trace: &Trace) -> Failsafes {
    let first = trace.failsafes().next();
    Failsafes {
        count: trace.failsafes().count(),
        first_s: first.map(|(tick, _)| tick.time),
        first_state: first.and_then(|(_, failsafe)| trace.states.get(failsafe.left).cloned()),
        first_cause: first.map(|(_, failsafe)| failsafe.cause.to_string()),
    }
}

impl Serialize for Outcome {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.name())
    }
}
