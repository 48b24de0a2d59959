//! The result of a run, as programs read it.

use super::Document;
use serde::{Serialize, Serializer};

use crate::run::{Run, Trace};
use crate::scene::Outcome;
use crate::score::{CornerFigures, CornerStatistics, Moments, RetrievalFigures, Score, StateShare, TipDistance};

/// The result of a run, in the units that its keys name; serialised, it is what `run --json` prints.
///
/// Every key is always there, with `null` for a figure that the run does not have. Numbers keep their full precision, so
/// that results can be compared bit for bit.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
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
    /// Wall time from when the run was asked for to the end of its first tick: reading, compiling, building.
    pub start_s: f64,
    /// Wall time of the loop alone.
    pub wall_s: f64,
    /// Simulated time over wall time; `None` if the clock saw none pass.
    pub realtime: Option<f64>,
    /// Distance of the tip estimates from the nearest surface.
    pub error_mm: ErrorMm,
    /// Distance of the tip estimates from the true tips; `None` if the run recorded no tip.
    pub tip_error_mm: Option<TipErrorMm>,
    /// Share of the reference that was traced, 0 to 1.
    pub coverage: f64,
    /// Share of the outline of the object whose loop closed that was traced, 0 to 1.
    pub object_coverage: f64,
    /// Share of the reference that was not traced and that the rig certainly cannot reach, 0 to 1.
    pub out_of_reach: f64,
    /// Share of the rest of the reference that was traced, 0 to 1.
    pub coverage_in_reach: f64,
    /// How the platform went through a tunnel; `None` outside of one.
    pub passage: Option<Passage>,
    /// Symmetric Hausdorff distance between the estimated contour and the reference.
    pub hausdorff_mm: Option<f64>,
    /// The states that were left by their failsafe.
    pub failsafes: Failsafes,
    /// The retrievals of whiskers that had lost the object; `None` if the policy made no marks.
    pub retrieval: Option<Retrieval>,
    /// Distance of the estimated midpoints from the axis of a tunnel; `None` outside of one.
    pub axis_mm: Option<MeanStd>,
    /// Sharp corners of the reference contour; `None` if it has none.
    pub corners: Option<Corners>,
    /// Share of the time in each state that was active, 0 to 1; of nested states the innermost counts.
    #[serde(serialize_with = "shares")]
    #[cfg_attr(test, schemars(with = "std::collections::BTreeMap<String, f64>"))]
    pub states: Vec<StateShare>,
    /// Length of the path of the platform's centre of mass.
    pub path_m: f64,
    /// That length over the reference contour's.
    pub path_ratio: f64,
    /// Contacts of the platform's body.
    pub collisions: Collisions,
    /// Wall time of a control tick.
    pub tick_us: TickUs,
    /// What the run depends on.
    pub hash: Hashes,
}

impl Document for RunResult {
    const FORMAT: &'static str = "run";
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
#[cfg_attr(test, derive(schemars::JsonSchema))]
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
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct ErrorMm {
    /// Mean.
    pub mean: Option<f64>,
    /// Sample standard deviation.
    pub std: Option<f64>,
    /// 95th percentile.
    pub p95: Option<f64>,
    /// Maximum.
    pub max: Option<f64>,
    /// Share of the estimates that lie within the band of 95 % that they tell themselves, 0 to 1.
    pub within_band: Option<f64>,
    /// Share of the estimates whose error exceeds 0.1 mm plus four of their own standard deviations, 0 to 1.
    pub outliers: Option<f64>,
    /// Number of estimates.
    pub n: usize,
}

/// Distance of the tip estimates from the true tips (mm).
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct TipErrorMm {
    /// Along the outline.
    pub along: MeanP95Max,
    /// Across the outline.
    pub across: MeanP95Max,
}

/// How the platform went through a tunnel.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Passage {
    /// Share of the tunnel's length that the platform's centre of mass went through between the walls, 0 to 1.
    pub share: f64,
    /// Share of the left inner side that was traced between the first and the last contact, 0 to 1.
    pub left_coverage: f64,
    /// Share of the right inner side.
    pub right_coverage: f64,
    /// Whether the whiskers of the rig reach both walls at once.
    pub reaches_both: bool,
    /// The share of the two that counts: the lesser if the whiskers reach both walls at once, else the greater.
    pub wall_coverage: f64,
}

/// Mean, 95th percentile and maximum, in the unit of the key that holds them.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct MeanP95Max {
    /// Mean.
    pub mean: f64,
    /// 95th percentile.
    pub p95: f64,
    /// Maximum.
    pub max: f64,
}

/// States that were left by their failsafe.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
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
#[cfg_attr(test, derive(schemars::JsonSchema))]
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

/// Sharp corners, which turn by more than 20°: how well they were found, and what they cost.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Corners {
    /// How many there are.
    pub count: usize,
    /// How many of them were traced on both sides; the figures are of these.
    pub traced: usize,
    /// Distance of the estimated corner, where lines through the tips of its two sides meet, from the exact one.
    pub place_mm: MeanStdMax,
    /// How much more or less than the exact corner the estimated one turns, without sign.
    pub angle_rad: MeanStdMax,
    /// Distance of the last tip before the whisker left the contour from the corner; `null` if it never did.
    pub edge_mm: MeanStdMax,
    /// Time from that tip to the first one when the whisker was back on the contour; 0 if it did not leave it.
    pub time_s: MeanStdMax,
    /// Path of the platform's centre of mass in that time.
    pub path_m: MeanStdMax,
}

/// Contacts of the platform's body.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Collisions {
    /// How many separate ones.
    pub count: usize,
    /// Time in touch.
    pub time_s: f64,
}

/// Mean, sample standard deviation and maximum, in the unit of the key that holds them.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct MeanStdMax {
    /// Mean.
    pub mean: Option<f64>,
    /// Sample standard deviation.
    pub std: Option<f64>,
    /// Maximum.
    pub max: Option<f64>,
}

/// Mean and sample standard deviation, in the unit of the key that holds them.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct MeanStd {
    /// Mean.
    pub mean: Option<f64>,
    /// Sample standard deviation.
    pub std: Option<f64>,
}

/// Wall time of a control tick (µs).
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
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
            start_s: run.start.as_secs_f64(),
            wall_s,
            realtime: (wall_s > 0.0).then(|| sim_s / wall_s),
            error_mm: ErrorMm {
                mean: error.map(|error| millimetres(error.mean)),
                std: error.and_then(|error| error.std).map(millimetres),
                p95: error.map(|error| millimetres(error.p95)),
                max: error.map(|error| millimetres(error.max)),
                within_band: error.map(|error| error.interval_coverage),
                outliers: error.map(|error| error.outliers),
                n: error.map_or(0, |error| error.count),
            },
            tip_error_mm: error.and_then(|error| {
                let figures = |distance: TipDistance| MeanP95Max {
                    mean: millimetres(distance.mean),
                    p95: millimetres(distance.p95),
                    max: millimetres(distance.max),
                };
                Some(TipErrorMm { along: figures(error.along?), across: figures(error.across?) })
            }),
            coverage: score.coverage,
            object_coverage: score.object_coverage,
            out_of_reach: score.out_of_reach,
            coverage_in_reach: score.coverage_in_reach(),
            passage: score.passage.map(|passage| Passage {
                share: passage.share,
                left_coverage: passage.left_coverage,
                right_coverage: passage.right_coverage,
                reaches_both: passage.reaches_both,
                wall_coverage: passage.wall_coverage(),
            }),
            hausdorff_mm: score.hausdorff.map(millimetres),
            failsafes: failsafes(&run.trace),
            retrieval: score.retrieval.as_ref().map(Retrieval::new),
            axis_mm: score.axis.map(|axis| MeanStd::new(Some(axis), 1e3)),
            corners: score.corners.as_ref().map(Corners::new),
            states: score.states.clone(),
            path_m: score.path,
            path_ratio: score.path_ratio,
            collisions: Collisions { count: score.collisions.count, time_s: score.collisions.time },
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

impl Corners {
    fn new(figures: &CornerFigures) -> Self {
        Self {
            count: figures.count,
            traced: figures.traced,
            place_mm: MeanStdMax::new(figures.place, 1e3),
            angle_rad: MeanStdMax::new(figures.turn, 1.0),
            edge_mm: MeanStdMax::new(figures.edge, 1e3),
            time_s: MeanStdMax::new(figures.time, 1.0),
            path_m: MeanStdMax::new(figures.path, 1.0),
        }
    }
}

impl MeanStdMax {
    fn new(figure: Option<CornerStatistics>, units: f64) -> Self {
        let MeanStd { mean, std } = MeanStd::new(figure.map(|figure| figure.moments), units);
        Self { mean, std, max: figure.map(|figure| figure.max * units) }
    }
}

impl MeanStd {
    /// A spread (SI) in a unit of which there are `units` in the SI's.
    fn new(spread: Option<Moments>, units: f64) -> Self {
        Self {
            mean: spread.map(|spread| spread.mean * units),
            std: spread.and_then(|spread| spread.std).map(|std| std * units),
        }
    }
}

fn shares<S: Serializer>(states: &[StateShare], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_map(states.iter().map(|StateShare { state, share }| (state, share)))
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
