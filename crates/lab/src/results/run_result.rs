//! The result of a run as a JSON document.

use super::Document;
use super::calibration_identity::CalibrationIdentity;
use super::collisions::Collisions;
use super::contract_result::ContractResult;
use super::ending::{Ending, described, is_of_largest_error};
use super::failsafes::Failsafes;
use super::inclination::Inclination;
use super::largest_error::LargestError;
use super::whisker_response::WhiskerResponse;
use serde::{Serialize, Serializer};

use crate::run::{Run, Trace};
use crate::score::{
    CornerFigures, CornerStatistics, Moments, OutOfPlaneFigures, RetrievalFigures, Score, StateShare, TipDistance,
};
use vibrissa_runtime::machine::Program;
use vibrissa_world::mismatch::Mismatch;
use vibrissa_world::scene::Violation;

/// The result of a run, in the units of its keys. Its serialised form is the output of `run --json`.
///
/// Every key is always present. It is `null` for a figure that the run does not have. Numbers have full precision, so
/// that results can be compared bit by bit.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct RunResult {
    /// Name of the scenario.
    pub scenario: String,
    /// Name of the policy.
    pub policy: String,
    /// True if the policy used true tip positions, an ideal sensor that no robot has.
    pub true_tips: bool,
    /// Name of the world.
    pub world: String,
    /// Seed of the sensor noise.
    pub seed: u64,
    /// The mismatch between the simulated array and the assumed one. `None` without one.
    pub mismatch: Option<MismatchIdentity>,
    /// The calibration of the array that control assumed. `None` for an array that is the assumed one, and that no
    /// calibration changes.
    pub calibration: Option<CalibrationIdentity>,
    /// Outcome of the run. `ended` means that it met its stop condition, but not all expectations of its scenario.
    pub outcome: Ending,
    /// Descriptions of the expectations that do not hold. Empty if all hold.
    pub violations: Vec<String>,
    /// True if all expectations hold but for a bound of the largest error.
    pub passed_but_for_tips: bool,
    /// Reason of the outcome, such as the text of the policy's `Success` or `Failure`. `None` if a stop condition completed
    /// the run.
    pub reason: Option<String>,
    /// Name of the last state.
    pub final_state: String,
    /// Simulated time.
    pub sim_s: f64,
    /// Wall time from the request of the run to the end of its first tick: reading, compiling, building.
    pub start_s: f64,
    /// Wall time of the control loop alone.
    pub wall_s: f64,
    /// Ratio of simulated time to wall time. `None` for a wall time of zero.
    pub realtime: Option<f64>,
    /// Distance of the tip estimates from the nearest surface.
    pub error_mm: ErrorMm,
    /// The tip estimate with the largest of these distances. `None` if the run recorded no tip.
    pub largest_error: Option<LargestError>,
    /// Distance of the tip estimates from the true tips. `None` if the run recorded no tip.
    pub tip_error_mm: Option<TipErrorMm>,
    /// Share of the reference that was traced, 0 to 1.
    pub coverage: f64,
    /// Share of the outline of the object whose loop closed that was traced, 0 to 1.
    pub object_coverage: f64,
    /// Share of each outline of the reference that was traced, 0 to 1, in the order of the objects.
    pub outline_coverages: Vec<f64>,
    /// Share of the reference that was not traced and that the rig certainly cannot reach, 0 to 1.
    pub out_of_reach: f64,
    /// Share of the rest of the reference that was traced, 0 to 1.
    pub coverage_in_reach: f64,
    /// Passage of the platform through a tunnel. `None` outside of tunnels.
    pub passage: Option<Passage>,
    /// Symmetric Hausdorff distance between the estimated contour and the reference.
    pub hausdorff_mm: Option<f64>,
    /// The fallback transitions.
    pub failsafes: Failsafes,
    /// The contracts of the policy that the run watched.
    pub contracts: Vec<ContractResult>,
    /// The retrievals of whiskers that had lost the object. `None` if the policy made no marks.
    pub retrieval: Option<Retrieval>,
    /// Distance of the estimated midpoints from the axis of a tunnel. `None` outside of tunnels.
    pub axis_mm: Option<MeanStd>,
    /// Sharp corners of the reference contour. `None` if it has none.
    pub corners: Option<Corners>,
    /// Share of the time in each state, 0 to 1. Of nested states only the innermost counts.
    #[serde(serialize_with = "shares")]
    #[cfg_attr(feature = "schema", schemars(with = "std::collections::BTreeMap<String, f64>"))]
    pub states: Vec<StateShare>,
    /// Length of the path of the platform's centre of mass.
    pub path_m: f64,
    /// Ratio of that length to the length of the reference contour.
    pub path_ratio: f64,
    /// Contacts of the platform's body.
    pub collisions: Collisions,
    /// Motion of tips out of the plane. `None` for planar whiskers.
    pub out_of_plane: Option<OutOfPlane>,
    /// Angle between a shaft at its base and the surface that it follows, as perceived. `None` if no whisker recorded a
    /// contour.
    pub inclination: Option<Inclination>,
    /// How perception followed the bends of each whisker.
    pub whiskers: Vec<WhiskerResponse>,
    /// Wall time of a control tick.
    pub tick_us: TickUs,
    /// Hashes of the inputs of the run.
    pub hash: Hashes,
}

impl Document for RunResult {
    const FORMAT: &'static str = "run";
    // A run that met its stop condition but not all expectations was `completed`.
    const VERSION: u32 = 2;
}

/// Names and hashes that identify a run.
#[derive(Debug, Clone, PartialEq)]
pub struct Identity {
    /// Name of the scenario.
    pub scenario: String,
    /// Name of the policy.
    pub policy: String,
    /// True if the policy used true tip positions.
    pub true_tips: bool,
    /// Name of the world.
    pub world: String,
    /// Seed of the sensor noise.
    pub seed: u64,
    /// The mismatch between the simulated array and the assumed one. `None` without one.
    pub mismatch: Option<MismatchIdentity>,
    /// The calibration of the array that control assumed. `None` for an array that is the assumed one, and that no
    /// calibration changes.
    pub calibration: Option<CalibrationIdentity>,
    /// Hashes of the inputs of the run.
    pub hash: Hashes,
}

/// The mismatch between the simulated array and the assumed one. Its ranges are part of the scenario's hash.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct MismatchIdentity {
    /// Path of its file. `None` if the scenario alone has it.
    pub file: Option<String>,
    /// Seed of the values that are drawn from ranges.
    pub seed: u64,
    /// True if a value is a range, so that the seed has an effect.
    #[serde(skip)]
    pub is_drawn: bool,
}

impl From<&Mismatch> for MismatchIdentity {
    fn from(mismatch: &Mismatch) -> Self {
        Self { file: mismatch.file.clone(), seed: mismatch.seed.unwrap_or(0), is_drawn: mismatch.is_drawn() }
    }
}

/// Hashes of everything that a run depends on. Runs with equal hashes and seed have equal results.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Hashes {
    /// Hash of the scenario.
    pub scenario: String,
    /// Hash of the policy with its parameters.
    pub policy: String,
    /// Hash of the program and the simulator.
    pub engine: String,
}

/// Distance of the tip estimates from the nearest surface (mm).
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct ErrorMm {
    /// Mean.
    pub mean: Option<f64>,
    /// Sample standard deviation.
    pub std: Option<f64>,
    /// 95th percentile.
    pub p95: Option<f64>,
    /// Maximum.
    pub max: Option<f64>,
    /// Share of the estimates within the 95 % interval that they report, 0 to 1.
    pub within_band: Option<f64>,
    /// Share of the estimates whose error exceeds 0.1 mm plus four reported standard deviations, 0 to 1.
    pub outliers: Option<f64>,
    /// Number of estimates.
    pub n: usize,
}

/// Distance of the tip estimates from the true tips (mm).
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct TipErrorMm {
    /// Along the contour.
    pub along: MeanP95Max,
    /// Perpendicular to the contour.
    pub across: MeanP95Max,
    /// Mean magnitude of the mean error of each whisker perpendicular to the contour.
    pub bias: f64,
    /// Standard deviation of that error about the mean of its whisker. `None` if no whisker has two tips.
    pub scatter: Option<f64>,
}

/// Passage of the platform through a tunnel.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Passage {
    /// Share of the tunnel's length that the platform's centre of mass covered between the walls, 0 to 1.
    pub share: f64,
    /// Share of the left inner side that was traced between the first and the last contact, 0 to 1.
    pub left_coverage: f64,
    /// Share of the right inner side.
    pub right_coverage: f64,
    /// True if the whiskers of the rig reach both walls at once.
    pub reaches_both: bool,
    /// The lesser share of the two if the whiskers reach both walls at once, else the greater one.
    pub wall_coverage: f64,
}

/// Mean, 95th percentile and maximum, in the unit of the key that holds them.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct MeanP95Max {
    /// Mean.
    pub mean: f64,
    /// 95th percentile.
    pub p95: f64,
    /// Maximum.
    pub max: f64,
}

/// Retrievals of whiskers that had lost the object, by the baseline's definitions (section 5.2 of its report).
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Retrieval {
    /// Number of retrievals.
    pub count: usize,
    /// Distance between the edge point, the last recorded tip before contact was lost, and the point at which contact
    /// was found again.
    pub radius_mm: MeanStd,
    /// Length of the path of the platform's centre of mass between the two.
    pub distance_mm: MeanStd,
    /// Time between the two.
    pub time_s: MeanStd,
}

/// Accuracy and cost of the sharp corners, which turn by more than 20°.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Corners {
    /// Number of sharp corners.
    pub count: usize,
    /// Number of corners that were traced on both sides. The figures are those of these corners.
    pub traced: usize,
    /// Distance of the estimated corner from the exact one. The estimated corner is the intersection of lines through
    /// the tips of its two sides.
    pub place_mm: MeanStdMax,
    /// Magnitude of the difference between the turning angles of the estimated and the exact corner.
    pub angle_rad: MeanStdMax,
    /// Distance between the corner and the last tip before the whisker left the contour. `null` if it never left it.
    pub edge_mm: MeanStdMax,
    /// Time from that tip to the first tip after the whisker was back on the contour. 0 if it did not leave it.
    pub time_s: MeanStdMax,
    /// Path of the platform's centre of mass in that time.
    pub path_m: MeanStdMax,
}

/// Motion of tips out of the plane.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct OutOfPlane {
    /// Largest distance of a tip from the plane.
    pub max_mm: f64,
    /// Number of slips: a tip came above the top or below the bottom of the objects.
    pub slips: usize,
    /// Time of the first slip.
    pub first_s: Option<f64>,
    /// Name of the whisker of the first slip.
    pub first_whisker: Option<String>,
    /// Name of the active state at the first slip.
    pub first_state: Option<String>,
}

/// Mean, sample standard deviation and maximum, in the unit of the key that holds them.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
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
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct MeanStd {
    /// Mean.
    pub mean: Option<f64>,
    /// Sample standard deviation.
    pub std: Option<f64>,
}

/// Wall time of a control tick (µs).
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct TickUs {
    /// Mean.
    pub mean: Option<f64>,
    /// 99th percentile.
    pub p99: Option<f64>,
    /// Maximum.
    pub max: Option<f64>,
}

impl RunResult {
    /// The name of the policy for people. It says so if the policy used true tips.
    #[must_use]
    pub fn policy_label(&self) -> String {
        marked(&self.policy, self.true_tips)
    }

    /// The reason of an outcome that is not `completed`: the expectations that do not hold of a run that ended, or why it
    /// stopped before. `None` for a run that completed without a text of its policy.
    #[must_use]
    pub fn explanation(&self) -> Option<String> {
        match self.outcome {
            Ending::Ended => Some(self.violations.join("; ")),
            _ => self.reason.clone(),
        }
    }

    /// The whiskers that seem dead or insensitive.
    pub fn dead_whiskers(&self) -> impl Iterator<Item = &WhiskerResponse> {
        self.whiskers.iter().filter(|whisker| whisker.seems_dead)
    }

    /// The result of `run` with this `score` and these `violations` of the scenario.
    #[must_use]
    pub fn new(identity: Identity, run: &Run, score: &Score, violations: &[Violation]) -> Self {
        let Identity { scenario, policy, true_tips, world, seed, mismatch, calibration, hash } = identity;
        let millimetres = |metres: f64| metres * 1e3;
        let microseconds = |seconds: f64| seconds * 1e6;
        let (error, latency) = (score.error, score.latency);
        let sim_s = run.trace.ticks.last().map_or(0.0, |tick| tick.time);
        let wall_s = run.wall.as_secs_f64();
        Self {
            scenario,
            policy,
            true_tips,
            world,
            seed,
            mismatch,
            calibration,
            outcome: Ending::new(run.outcome, violations),
            violations: violations.iter().map(|violation| described(violation, run.reason.as_deref())).collect(),
            passed_but_for_tips: violations.iter().all(is_of_largest_error),
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
            largest_error: score.largest_error.as_ref().and_then(|tip| LargestError::new(tip, &run.trace)),
            tip_error_mm: error.and_then(|error| {
                let figures = |distance: TipDistance| MeanP95Max {
                    mean: millimetres(distance.mean),
                    p95: millimetres(distance.p95),
                    max: millimetres(distance.max),
                };
                Some(TipErrorMm {
                    along: figures(error.along?),
                    across: figures(error.across?),
                    bias: millimetres(error.bias?),
                    scatter: error.scatter.map(millimetres),
                })
            }),
            coverage: score.coverage,
            object_coverage: score.object_coverage,
            outline_coverages: score.outline_coverages.clone(),
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
            failsafes: Failsafes::new(&run.trace),
            contracts: run.contracts.iter().map(ContractResult::new).collect(),
            retrieval: score.retrieval.as_ref().map(Retrieval::new),
            axis_mm: score.axis.map(|axis| MeanStd::new(Some(axis), 1e3)),
            corners: score.corners.as_ref().map(Corners::new),
            states: score.states.clone(),
            path_m: score.path,
            path_ratio: score.path_ratio,
            collisions: Collisions::new(&score.collisions, &run.trace),
            out_of_plane: score.out_of_plane.map(|figures| OutOfPlane::new(&figures, &run.trace)),
            inclination: score.inclination.as_ref().map(|figures| Inclination::new(figures, &run.trace)),
            whiskers: score.responses.iter().filter_map(|one| WhiskerResponse::new(one, &run.trace)).collect(),
            tick_us: TickUs {
                mean: latency.map(|latency| microseconds(latency.mean)),
                p99: latency.map(|latency| microseconds(latency.p99)),
                max: latency.map(|latency| microseconds(latency.max)),
            },
            hash,
        }
    }
}

/// The name of a policy for people. It says so if the policy uses true tips.
#[must_use]
pub fn policy_label(program: &Program) -> String {
    marked(&program.name, program.uses_true_tips())
}

/// The name of a policy, or of its file, with a mark if it used true tips.
pub fn marked(policy: &str, true_tips: bool) -> String {
    if true_tips { format!("{policy} (true tips)") } else { policy.to_owned() }
}

impl OutOfPlane {
    fn new(figures: &OutOfPlaneFigures, trace: &Trace) -> Self {
        let first = figures.first;
        Self {
            max_mm: figures.distance * 1e3,
            slips: figures.slips,
            first_s: first.map(|slip| slip.time),
            first_whisker: first.and_then(|slip| trace.whiskers.get(slip.whisker).cloned()),
            first_state: first.and_then(|slip| state_name(trace, slip.state)),
        }
    }
}

pub(super) fn state_name(trace: &Trace, state: Option<usize>) -> Option<String> {
    trace.states.get(state?).cloned()
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
    /// Mean and standard deviation in another unit. There are `units` of it in the SI unit.
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
