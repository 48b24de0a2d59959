//! Run time and error of one setting.

use serde::Serialize;

use crate::results::{CalibrationIdentity, Document, Ending, MismatchIdentity};
use crate::score::Statistics;
use vibrissa_world::scene::{Scene, WorldKind};

use super::measure::Measured;
use super::setting::Setting;

/// Run times and errors of the settings of a scene.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Pareto {
    /// The scenario.
    pub scenario: String,
    /// The policy.
    pub policy: String,
    /// Its contact estimators, whisker by whisker.
    #[serde(rename = "tip_models")]
    pub contact_estimators: Vec<&'static str>,
    /// The mismatch of the runs with a wrong model of the array.
    pub mismatch: MismatchIdentity,
    /// The calibration of the array in these runs. `None` without a mismatch.
    pub calibration: Option<CalibrationIdentity>,
    /// Number of runs of every setting with the right model.
    pub repeats: usize,
    /// Mean distance (mm) between the tips of a second fine run, from a start 1 mm behind, and the contour of the fine
    /// run. Smaller differences are not significant.
    pub floor_mm: Option<f64>,
    /// The settings. The first is the default, the second the fine one.
    pub settings: Vec<ParetoRow>,
}

impl Document for Pareto {
    const FORMAT: &'static str = "pareto";
    // A run that met its stop condition but not all expectations was `completed`.
    const VERSION: u32 = 2;
}

/// Run time and error of one setting.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct ParetoRow {
    /// The changes to the scenario.
    pub setting: String,
    /// The kind of change: `default`, `fine`, `links`, `step`, `contacts`, `integrator`, `solver`, `world`, `tip
    /// model`, or `several`.
    pub axis: &'static str,
    /// The world.
    pub world: &'static str,
    /// Links of the first whisker.
    pub links: usize,
    /// Length of a step. In the quasi-static world, the time between samples.
    pub step_ms: f64,
    /// Time constant of contacts. `None` if contacts are rigid.
    pub contact_time_ms: Option<f64>,
    /// MuJoCo's integrator.
    pub integrator: Option<&'static str>,
    /// MuJoCo's solver.
    pub solver: Option<&'static str>,
    /// Outcome of the run.
    pub outcome: Ending,
    /// Reason of the outcome. `None` for a completed run.
    pub reason: Option<String>,
    /// Simulated time.
    pub sim_s: f64,
    /// Processor time of the run, the median over all rounds.
    pub processor_s: Option<f64>,
    /// Ratio of the processor time to that of the default in the same round, the median over all rounds.
    pub relative_time: Option<f64>,
    /// The smallest and the largest of these ratios.
    pub relative_time_range: Option<[f64; 2]>,
    /// Mean distance of the tips from the exact contour.
    pub error_mm: Option<f64>,
    /// Mean distance of the tips from the contour that the fine run estimated. `None` for another contact estimator.
    pub fine_mm: Option<f64>,
    /// Outcome of the run with a wrong model of the array.
    pub mismatched_outcome: Ending,
    /// Mean distance of the tips of this run from the exact contour.
    pub mismatched_mm: Option<f64>,
    /// Share of the exact contour that was traced, 0 to 1. `None` for another contact estimator.
    pub coverage: Option<f64>,
    /// True if the setting is Pareto-optimal among all settings.
    pub on_front: Front,
    /// True if the setting is Pareto-optimal among the settings of its world.
    pub on_front_of_world: Front,
}

/// Pareto-optimality of a setting by either error.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[expect(clippy::struct_excessive_bools, reason = "one for each error that is compared")]
pub struct Front {
    /// By the error against the exact contour.
    pub exact: bool,
    /// By the error against the fine run.
    pub fine: bool,
    /// By the error against the exact contour with a wrong model of the array.
    pub mismatched: bool,
    /// By both errors against the exact contour together, with the right and with a wrong model of the array. No other
    /// setting is at least as good in run time and both errors, and better in one of the three.
    pub together: bool,
}

impl Front {
    pub(super) fn or(self, other: Self) -> Self {
        Self {
            exact: self.exact || other.exact,
            fine: self.fine || other.fine,
            mismatched: self.mismatched || other.mismatched,
            together: self.together || other.together,
        }
    }
}

impl ParetoRow {
    /// True if the run met its stop condition.
    pub(crate) fn met_its_stop(&self) -> bool {
        self.outcome.met_its_stop()
    }

    /// The error (mm) with a wrong model of the array, if that run met its stop condition.
    pub(crate) fn usable_mismatched_mm(&self) -> Option<f64> {
        self.mismatched_mm.filter(|_| self.mismatched_outcome.met_its_stop())
    }

    /// The row of a setting. `scene` and `world` are the result of the setting. There are a run with the right model and
    /// one with a wrong model of the array. `figures` has the statistics of relative and absolute times (s).
    pub(super) fn new(
        setting: &Setting,
        (scene, world): (&Scene, WorldKind),
        (first, mismatched): (&Measured, &Measured),
        figures: Option<(Statistics, Statistics)>,
        fine_mm: Option<f64>,
    ) -> Self {
        let is_mujoco = world == WorldKind::Mujoco;
        let Scene { rig, physics, .. } = scene;
        let (ratios, seconds) = figures.unzip();
        Self {
            setting: setting.to_string(),
            axis: setting.axis(),
            world: world.name(),
            links: rig.whiskers.first().map_or(0, |whisker| whisker.shaft.links),
            step_ms: 1e3 * if is_mujoco { physics.step } else { rig.sensing.sample_rate.recip() },
            contact_time_ms: is_mujoco.then_some(1e3 * physics.contact_time),
            integrator: is_mujoco.then_some(physics.integrator.name()),
            solver: is_mujoco.then_some(physics.solver.name()),
            outcome: first.ending,
            reason: first.reason.clone(),
            sim_s: first.sim_s,
            processor_s: seconds.map(|seconds| seconds.percentile(50.0)),
            relative_time: ratios.as_ref().map(|ratios| ratios.percentile(50.0)),
            relative_time_range: ratios.map(|ratios| [ratios.percentile(0.0), ratios.max()]),
            error_mm: first.error_mm,
            fine_mm,
            mismatched_outcome: mismatched.ending,
            mismatched_mm: mismatched.error_mm,
            coverage: first.coverage,
            on_front: Front::default(),
            on_front_of_world: Front::default(),
        }
    }
}
