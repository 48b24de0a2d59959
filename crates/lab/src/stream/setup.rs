//! What a page has to know of a run before it begins.

use std::sync::Arc;

use vibrissa_runtime::machine::Program;
use vibrissa_runtime::rig::Rig;

use crate::trial::Trial;
use vibrissa_text::diagnostic::Source;
use vibrissa_world::geometry::Pose;
use vibrissa_world::scene::Scene;

/// What a page has to know of a run before it begins.
#[derive(Debug)]
pub struct RunSetup {
    /// The command: `run`, `replay` or `drive`.
    pub command: &'static str,
    /// Name of the scenario.
    pub scenario: String,
    /// Name of the simulator. `None` if it is not known.
    pub world: Option<String>,
    /// Longest duration (s). `None` if it is not known.
    pub duration: Option<f64>,
    /// Number of ticks, if all are known from the beginning.
    pub known_ticks: Option<usize>,
    /// The rig that control assumes.
    pub rig: Rig,
    /// The scene, if it is known.
    pub scene: Option<Scene>,
    /// The pose of the platform before the first tick, if it is known.
    pub start: Option<Pose>,
    /// The trial, if its world can be simulated again.
    pub trial: Option<Trial>,
    /// The program of the run.
    pub program: Arc<Program>,
    /// The text of the policy, if there is one.
    pub policy: Option<Source>,
    /// Why there are no guards, if there are none.
    pub no_guards: Option<String>,
    /// True if the times of the loop are emulated.
    pub is_emulated: bool,
}

impl RunSetup {
    /// A simulated run of a trial. `policy` is the text of its policy, if there is one.
    #[must_use]
    pub fn simulated(trial: &Trial, policy: Option<Source>) -> Self {
        let no_guards =
            "the policy is a compiled machine, whose guards have no text; run the policy itself to see them";
        Self {
            command: "run",
            scenario: trial.scene.name.clone(),
            world: Some(trial.world.kind.to_string()),
            duration: Some(trial.scene.stop.time),
            known_ticks: None,
            rig: trial.assumed_rig.clone(),
            scene: Some(trial.scene.clone()),
            start: Some(trial.scene.start),
            trial: Some(trial.clone()),
            program: Arc::clone(&trial.program),
            no_guards: policy.is_none().then(|| no_guards.to_owned()),
            policy,
            is_emulated: false,
        }
    }

    /// A run of a trial by the loop of the robot. The rig that control assumes is `rig`.
    #[must_use]
    pub fn emulated(trial: &Trial, rig: &Rig, policy: Option<Source>) -> Self {
        Self { command: "drive", rig: rig.clone(), trial: None, is_emulated: true, ..Self::simulated(trial, policy) }
    }
}
