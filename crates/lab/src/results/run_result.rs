//! The result of a run as a JSON document.

use super::Document;
use super::calibration_identity::CalibrationIdentity;
use super::collisions::Collisions;
use super::contract_result::ContractResult;
use super::ending::{Ending, described, is_of_largest_error};
use super::failsafes::Failsafes;
use super::inclination::Inclination;
use super::largest_error::LargestError;
use super::section::{Keyed, Section};
use super::whisker_response::WhiskerResponse;
use std::fmt::{self, Formatter};

use serde::de::{MapAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use crate::run::{Run, Trace};
use crate::score::{OutOfPlaneFigures, Score, StateShare};
use vibrissa_declare::figures::Metric;
use vibrissa_runtime::machine::Program;
use vibrissa_world::mismatch::Mismatch;
use vibrissa_world::scene::Violation;

/// The result of a run, in the units of its keys. Its serialised form is the output of `run --json`.
///
/// Every key is always present. It is `null` for a figure that the run does not have. Numbers have full precision, so
/// that results can be compared bit by bit.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
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
    #[serde(flatten)]
    pub(super) duration: Section<0>,
    /// Wall time from the request of the run to the end of its first tick: reading, compiling, building.
    pub start_s: f64,
    /// Wall time of the control loop alone.
    pub wall_s: f64,
    /// Ratio of simulated time to wall time. `None` for a wall time of zero.
    pub realtime: Option<f64>,
    #[serde(flatten)]
    pub(super) errors: Section<1>,
    /// The tip estimate with the largest of these distances. `None` if the run recorded no tip.
    pub largest_error: Option<LargestError>,
    #[serde(flatten)]
    pub(super) traced: Section<2>,
    /// Share of each outline of the reference that was traced, 0 to 1, in the order of the objects.
    pub outline_coverages: Vec<f64>,
    #[serde(flatten)]
    pub(super) reached: Section<3>,
    /// The fallback transitions.
    pub failsafes: Failsafes,
    /// The contracts of the policy that the run watched.
    pub contracts: Vec<ContractResult>,
    #[serde(flatten)]
    pub(super) passed: Section<4>,
    /// Share of the time in each state, 0 to 1. Of nested states only the innermost counts.
    #[serde(serialize_with = "shares", deserialize_with = "read_shares")]
    #[cfg_attr(feature = "schema", schemars(with = "std::collections::BTreeMap<String, f64>"))]
    pub states: Vec<StateShare>,
    #[serde(flatten)]
    pub(super) path: Section<5>,
    /// Contacts of the platform's body.
    pub collisions: Collisions,
    /// Motion of tips out of the plane. `None` for planar whiskers.
    pub out_of_plane: Option<OutOfPlane>,
    /// Angle between a shaft at its base and the surface that it follows, as perceived. `None` if no whisker recorded a
    /// contour.
    pub inclination: Option<Inclination>,
    /// How perception followed the bends of each whisker.
    pub whiskers: Vec<WhiskerResponse>,
    #[serde(flatten)]
    pub(super) latency: Section<10>,
    /// The friction of the objects. `None` without friction.
    #[serde(skip)]
    pub friction: Option<ObjectFriction>,
    /// Hashes of the inputs of the run.
    pub hash: Hashes,
}

impl Document for RunResult {
    const FORMAT: &'static str = "run";
    // A run that met its stop condition but not all expectations was `completed`.
    const VERSION: u32 = 2;
}

/// The friction between whiskers and objects.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ObjectFriction {
    /// Its coefficient.
    pub coefficient: f64,
    /// True if perception assumes at least half of it for every whisker.
    pub is_assumed: bool,
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
    /// The friction of the objects. `None` without friction.
    pub friction: Option<ObjectFriction>,
    /// Hashes of the inputs of the run.
    pub hash: Hashes,
}

/// The mismatch between the simulated array and the assumed one. Its ranges are part of the scenario's hash.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
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
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Hashes {
    /// Hash of the scenario.
    pub scenario: String,
    /// Hash of the policy with its parameters.
    pub policy: String,
    /// Hash of the program and the simulator.
    pub engine: String,
}

/// Motion of tips out of the plane.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct OutOfPlane {
    #[serde(flatten)]
    pub(super) figures: Section<7>,
    /// Time of the first slip.
    pub first_s: Option<f64>,
    /// Name of the whisker of the first slip.
    pub first_whisker: Option<String>,
    /// Name of the active state at the first slip.
    pub first_state: Option<String>,
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

    /// The value of a figure in the unit of its key, a truth as 1 or 0. `None` if the run or its document does not have it.
    #[must_use]
    pub fn figure(&self, metric: Metric) -> Option<f64> {
        self.sections().into_iter().flatten().find(|keyed| keyed.metric == metric)?.value
    }

    /// True if the body touched something.
    #[must_use]
    pub fn collided(&self) -> bool {
        self.figure(Metric::Collisions).is_some_and(|count| count > 0.0)
    }

    fn sections(&self) -> [&[Keyed]; 11] {
        let Self { out_of_plane, inclination, .. } = self;
        [
            self.duration.figures(),
            self.errors.figures(),
            self.traced.figures(),
            self.reached.figures(),
            self.passed.figures(),
            self.path.figures(),
            self.collisions.figures.figures(),
            out_of_plane.as_ref().map_or(&[], |part| part.figures.figures()),
            inclination.as_ref().map_or(&[], |part| part.angles.figures()),
            inclination.as_ref().map_or(&[], |part| part.beyond.figures()),
            self.latency.figures(),
        ]
    }

    /// The whiskers that seem dead or insensitive.
    pub fn dead_whiskers(&self) -> impl Iterator<Item = &WhiskerResponse> {
        self.whiskers.iter().filter(|whisker| whisker.seems_dead)
    }

    /// The result of `run` with this `score` and these `violations` of the scenario.
    #[must_use]
    pub fn new(identity: Identity, run: &Run, score: &Score, violations: &[Violation]) -> Self {
        let Identity { scenario, policy, true_tips, world, seed, mismatch, calibration, friction, hash } = identity;
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
            duration: Section::of(score),
            start_s: run.start.as_secs_f64(),
            wall_s,
            realtime: (wall_s > 0.0).then(|| score.time / wall_s),
            errors: Section::of(score),
            largest_error: score.largest_error.as_ref().and_then(|tip| LargestError::new(tip, &run.trace)),
            traced: Section::of(score),
            outline_coverages: score.outline_coverages.clone(),
            reached: Section::of(score),
            failsafes: Failsafes::new(&run.trace),
            contracts: run.contracts.iter().map(ContractResult::new).collect(),
            passed: Section::of(score),
            states: score.states.clone(),
            path: Section::of(score),
            collisions: Collisions::new(score, &run.trace),
            out_of_plane: score.out_of_plane.map(|figures| OutOfPlane::new(score, &figures, &run.trace)),
            inclination: score.inclination.as_ref().map(|figures| Inclination::new(score, figures, &run.trace)),
            whiskers: score.responses.iter().filter_map(|one| WhiskerResponse::new(one, &run.trace)).collect(),
            latency: Section::of(score),
            friction,
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
#[must_use]
pub fn marked(policy: &str, true_tips: bool) -> String {
    if true_tips { format!("{policy} (true tips)") } else { policy.to_owned() }
}

impl OutOfPlane {
    fn new(score: &Score, figures: &OutOfPlaneFigures, trace: &Trace) -> Self {
        let first = figures.first;
        Self {
            figures: Section::of(score),
            first_s: first.map(|slip| slip.time),
            first_whisker: first.and_then(|slip| trace.whiskers.get(slip.whisker).cloned()),
            first_state: first.and_then(|slip| state_name(trace, slip.state)),
        }
    }
}

pub(super) fn state_name(trace: &Trace, state: Option<usize>) -> Option<String> {
    trace.states.get(state?).cloned()
}

fn shares<S: Serializer>(states: &[StateShare], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_map(states.iter().map(|StateShare { state, share }| (state, share)))
}

/// Reads the shares in the order of the text.
fn read_shares<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<StateShare>, D::Error> {
    struct Shares;
    impl<'de> Visitor<'de> for Shares {
        type Value = Vec<StateShare>;

        fn expecting(&self, f: &mut Formatter<'_>) -> fmt::Result {
            f.write_str("the shares of states")
        }

        fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Self::Value, A::Error> {
            let next = || Some(map.next_entry().transpose()?.map(|(state, share)| StateShare { state, share }));
            std::iter::from_fn(next).collect()
        }
    }
    deserializer.deserialize_map(Shares)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]
    use super::*;
    use crate::built_in::SCENARIOS;
    use crate::request::{Input, TrialRequest};
    use vibrissa_world::scene::WorldKind;

    #[test]
    fn a_result_is_read_bit_for_bit_as_it_was_written() {
        let world = Some(WorldKind::QuasiStatic);
        let request = TrialRequest { world, ..TrialRequest::new(Input::BuiltIn(&SCENARIOS[0])) };
        let trial = request.prepare().unwrap().trial;
        for result in [trial.document(&trial.run().unwrap()), trial.refused("no reason".to_owned())] {
            let read: RunResult = serde_json::from_str(&serde_json::to_string(&result).unwrap()).unwrap();
            assert_eq!(read, result);
        }
    }
}
