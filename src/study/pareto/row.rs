//! What one setting costs, and what it is worth.

use crate::results::Document;
use serde::Serialize;

use crate::results::Ending;
use crate::scene::{Scene, WorldKind};
use crate::score::Statistics;

use super::measure::Measured;
use super::setting::Setting;

/// What a scene's settings cost, and what they are worth.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Pareto {
    /// The scenario.
    pub scenario: String,
    /// The policy.
    pub policy: String,
    /// Its tip models, whisker by whisker.
    pub tip_models: Vec<&'static str>,
    /// How often every setting was run.
    pub repeats: usize,
    /// The mean distance (mm) of the tips of the fine run, from a start 1 mm behind, from the contour of the fine run: what differs from
    /// that by less cannot be told apart.
    pub floor_mm: Option<f64>,
    /// The settings, the default first and the fine one second.
    pub settings: Vec<ParetoRow>,
}

impl Document for Pareto {
    const FORMAT: &'static str = "pareto";
}

/// What one setting costs, and what it is worth.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct ParetoRow {
    /// What is not as in the scenario.
    pub setting: String,
    /// What that is: `default`, `fine`, `links`, `step`, `contacts`, `integrator`, `solver`, `world`, `tip model`, or `several`.
    pub axis: &'static str,
    /// The world.
    pub world: &'static str,
    /// Links of the first whisker.
    pub links: usize,
    /// Length of a step; in the quasi-static world, of a sample.
    pub step_ms: f64,
    /// Time constant of contacts; `None` where surfaces are hard.
    pub contact_time_ms: Option<f64>,
    /// MuJoCo's integrator.
    pub integrator: Option<&'static str>,
    /// MuJoCo's solver.
    pub solver: Option<&'static str>,
    /// How the run ended.
    pub outcome: Ending,
    /// Why, if not as it should.
    pub reason: Option<String>,
    /// Simulated time.
    pub sim_s: f64,
    /// Time of the processor that the run took, the median of all.
    pub processor_s: Option<f64>,
    /// The same over that of the default in the same round, the median of all rounds.
    pub relative_time: Option<f64>,
    /// The least and the greatest of these.
    pub relative_time_range: Option<[f64; 2]>,
    /// Mean distance of its tips from the exact contour.
    pub error_mm: Option<f64>,
    /// Mean distance of its tips from the contour that the fine run estimated; `None` of another tip model.
    pub fine_mm: Option<f64>,
    /// Share of the exact contour that was traced, 0 to 1; `None` of another tip model.
    pub coverage: Option<f64>,
    /// Whether no other setting is at most as dear and at most as far off, and one of both less.
    pub on_front: Front,
    /// The same among the settings in its world.
    pub on_front_of_world: Front,
}

/// Whether a setting is on the fronts of time against error.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Front {
    /// Against the exact contour.
    pub exact: bool,
    /// Against the fine run.
    pub fine: bool,
}

impl Front {
    pub(super) fn or(self, other: Self) -> Self {
        Self { exact: self.exact || other.exact, fine: self.fine || other.fine }
    }
}

impl ParetoRow {
    /// Whether the run ended as it should.
    pub(crate) fn completed(&self) -> bool {
        self.outcome == Ending::Completed
    }

    /// The row of a setting, which makes this of rig and world; with the statistics of its relative and its absolute times (s).
    pub(super) fn new(
        setting: &Setting,
        scene: &Scene,
        world: WorldKind,
        first: &Measured,
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
            coverage: first.coverage,
            on_front: Front::default(),
            on_front_of_world: Front::default(),
        }
    }
}
