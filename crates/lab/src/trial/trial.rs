//! A trial and its result.

use std::borrow::Cow;
use std::fmt::Write;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

use sha2::{Digest, Sha256};
use vibrissa_runtime::control::Control;
use vibrissa_runtime::machine::Program;
use vibrissa_runtime::percept::Perception;
use vibrissa_runtime::rig::Rig;

use super::worlds::{ExecuteError, build_world, engine_hash};
use crate::results::{
    CalibrationIdentity, Ending, Hashes, Identity, MismatchIdentity, ObjectFriction, RunResult, policy_label, unmet,
};
use crate::run::{Progress, Run, SteppedRun, Stopwatch, Trace, Watcher, drive};
use crate::score::Score;
use vibrissa_world::scene::{Scene, Violation, WorldSetup};
use vibrissa_world::world::{World, with_true_tips};

/// A policy in a scene and a world: everything that a run depends on.
///
/// ```
/// use std::sync::Arc;
/// use vibrissa_text::diagnostic::Source;
/// use vibrissa_world::scene::WorldKind;
/// use vibrissa_lab::built_in;
/// use vibrissa_language as policy;
/// use vibrissa_world::scenario;
/// use vibrissa_lab::trial::Trial;
/// let disk = built_in::SCENARIOS[0];
/// let scene = scenario::read(&Source::new(disk.path, disk.text)).unwrap();
/// let text = std::fs::read_to_string("policies/bang.fsm").unwrap();
/// let program = policy::compile(&Source::new("bang.fsm", text)).unwrap();
/// let mut trial = Trial::new(scene, Arc::new(program));
/// trial.world = WorldKind::QuasiStatic.into();
/// let result = trial.run().unwrap();
/// assert!(result.run.trace.ticks.len() > 100);
/// ```
#[derive(Debug, Clone)]
pub struct Trial {
    /// The scene. Its rig with its mismatch is the one that is simulated.
    pub scene: Scene,
    /// The rig that control assumes: that of the scene, unless another one is studied.
    pub assumed_rig: Rig,
    /// The compiled policy.
    pub program: Arc<Program>,
    /// The world.
    pub world: WorldSetup,
    /// Seed of the sensor noise.
    pub seed: u64,
    /// True if samples have the true tips. A policy with the contact estimator `truth` has them in any case.
    pub true_tips: bool,
    /// The files that the trial was made from.
    pub inputs: Inputs,
}

/// The files that a trial was made from. Empty for a trial that was made in memory.
#[derive(Debug, Clone, Default)]
pub struct Inputs {
    /// Path of the scenario, for messages.
    pub scenario: PathBuf,
    /// Hash of the scenario and its files.
    pub scenario_hash: String,
    /// Hash of the policy, its libraries and its parameters.
    pub policy_hash: String,
    /// Wall time of reading and compiling.
    pub preparation: Duration,
}

impl Inputs {
    /// The scenario at a path and a policy, with these hashes.
    #[must_use]
    pub fn new(scenario: &Path, scenario_hash: Sha256, policy_hash: Sha256) -> Self {
        let [scenario_hash, policy_hash] = [scenario_hash, policy_hash].map(|hash| short_hash(&hash.finalize()));
        Self { scenario: scenario.to_owned(), scenario_hash, policy_hash, ..Self::default() }
    }
}

/// The result of a trial.
#[derive(Debug, Clone)]
pub struct TrialResult {
    /// The run.
    pub run: Run,
    /// Its score against the exact geometry.
    pub score: Score,
    /// The expectations of the scene that do not hold.
    pub violations: Vec<Violation>,
}

impl TrialResult {
    /// The outcome, judged by the expectations of the scene.
    #[must_use]
    pub fn ending(&self) -> Ending {
        Ending::new(self.run.outcome, &self.violations)
    }
}

impl Trial {
    /// A policy in a scene, in the world and with the seed of the scene.
    #[must_use]
    pub fn new(scene: Scene, program: Arc<Program>) -> Self {
        Self {
            assumed_rig: scene.assumed_rig(),
            world: scene.world.unwrap_or_default().into(),
            seed: scene.seed,
            true_tips: false,
            inputs: Inputs::default(),
            scene,
            program,
        }
    }

    /// Runs and scores the trial.
    ///
    /// # Errors
    /// [`ExecuteError`] if the run cannot begin. The outcome of a run is part of the result.
    pub fn run(&self) -> Result<TrialResult, ExecuteError> {
        self.run_with(|_| ControlFlow::Continue(()))
    }

    /// Runs and scores the trial. `progress` receives the trace after every tick, and may stop the run.
    ///
    /// # Errors
    /// [`ExecuteError`] if the run cannot begin, or if `progress` stopped it.
    pub fn run_with(&self, progress: impl FnMut(&Trace) -> ControlFlow<()>) -> Result<TrialResult, ExecuteError> {
        self.run_watched(&mut Progress(progress))
    }

    /// Runs and scores the trial. `watcher` receives every tick and the guards of the machine, and may stop the run.
    ///
    /// # Errors
    /// [`ExecuteError`] if the run cannot begin, or if `watcher` stopped it.
    pub fn run_watched(&self, watcher: &mut dyn Watcher) -> Result<TrialResult, ExecuteError> {
        let before = Stopwatch::start();
        let world = std::thread::scope(|scope| {
            let prepare = || Perception::prepare(&self.assumed_rig, &self.program.contact_estimators);
            // If the system starts no thread, perception is prepared when it is built.
            let _ = std::thread::Builder::new().spawn_scoped(scope, prepare);
            self.world()
        });
        let control = self.control()?;
        let mut world = world?;
        let built = before.elapsed();
        let mut run = self.drive(control, world.as_mut(), watcher)?;
        run.start += built + self.inputs.preparation;
        Ok(self.scored(run))
    }

    /// Runs and scores the trial in a `world` of the caller.
    ///
    /// # Errors
    /// [`ExecuteError`] if the rig does not have what the policy needs.
    pub fn run_in(&self, world: &mut dyn World) -> Result<TrialResult, ExecuteError> {
        let run = self.drive(self.control()?, world, &mut Progress(|_: &Trace| ControlFlow::Continue(())))?;
        Ok(self.scored(run))
    }

    /// Builds the world of the trial.
    ///
    /// # Errors
    /// [`ExecuteError`] if the world refuses the scene.
    pub fn world(&self) -> Result<Box<dyn World>, ExecuteError> {
        let world = build_world(&self.scene, self.world, self.seed)?;
        if self.true_tips || self.program.uses_true_tips() {
            return Ok(Box::new(with_true_tips(world, &self.true_rig(), self.scene.surfaces())));
        }
        Ok(world)
    }

    /// The rig that is simulated.
    fn true_rig(&self) -> Cow<'_, Rig> {
        self.scene.true_array().map_or(Cow::Borrowed(&self.scene.rig), |array| Cow::Owned(array.rig))
    }

    /// The control loop of the trial. In a simulator, the policy may use true tips.
    ///
    /// # Errors
    /// [`ExecuteError`] if the rig does not have what the policy needs.
    pub fn control(&self) -> Result<Control, ExecuteError> {
        self.check_map()?;
        Ok(Control::simulated(&self.assumed_rig, Arc::clone(&self.program))?)
    }

    /// Checks that the policy has a map if the run ends with one.
    ///
    /// # Errors
    /// [`ExecuteError::NoMap`] if it has none.
    pub(crate) fn check_map(&self) -> Result<(), ExecuteError> {
        if self.scene.stop.mapped && !self.program.uses_map() {
            return Err(ExecuteError::NoMap { policy: self.program.name.clone() });
        }
        Ok(())
    }

    /// The run of the trial at its start, to be stepped in its [world](Self::world).
    ///
    /// # Errors
    /// [`ExecuteError`] if the rig does not have what the policy needs.
    pub fn begin(&self) -> Result<SteppedRun, ExecuteError> {
        Ok(SteppedRun::new(self.control()?, self.scene.goal(), self.period()))
    }

    /// The control period (s).
    fn period(&self) -> f64 {
        self.scene.rig.sensing.control_rate.recip()
    }

    fn drive(&self, control: Control, world: &mut dyn World, watcher: &mut dyn Watcher) -> Result<Run, ExecuteError> {
        drive(world, control, self.scene.goal(), self.period(), watcher).ok_or(ExecuteError::Interrupted)
    }

    /// Scores a run of this trial. The reason of a run with a map says what is left.
    #[must_use]
    pub fn scored(&self, mut run: Run) -> TrialResult {
        let score = Score::new(&run, &self.scene.truth, &self.true_rig());
        if let Some(map) = &score.map {
            let left = map.left(score.coverage_in_reach());
            run.reason = Some(run.reason.map_or_else(|| left.to_string(), |reason| format!("{reason}; {left}")));
        }
        let violations = unmet(&self.scene.expect, &run, &score);
        TrialResult { run, score, violations }
    }

    /// The result as a JSON document.
    #[must_use]
    pub fn document(&self, result: &TrialResult) -> RunResult {
        RunResult::new(self.identity(), &result.run, &result.score, &result.violations)
    }

    /// The JSON document of this trial if it cannot begin for a `reason`.
    #[must_use]
    pub fn refused(&self, reason: String) -> RunResult {
        RunResult::refused(self.identity(), reason)
    }

    /// The name of the policy for people. It says so if the policy uses true tips.
    #[must_use]
    pub fn policy_label(&self) -> String {
        policy_label(&self.program)
    }

    /// The calibration of the array that control assumes. `None` for an array that is the assumed one, and that no calibration
    /// changes.
    #[must_use]
    pub fn calibration(&self) -> Option<CalibrationIdentity> {
        CalibrationIdentity::of(&self.scene, |text| short_hash(&Sha256::digest(text)))
    }

    /// The friction of the objects, if there is any.
    fn friction(&self) -> Option<ObjectFriction> {
        let coefficient = self.scene.physics.friction;
        let Rig { whiskers, sensing, .. } = &self.assumed_rig;
        let is_assumed = whiskers.iter().all(|whisker| whisker.friction(sensing) >= 0.5 * coefficient);
        (coefficient > 0.0).then_some(ObjectFriction { coefficient, is_assumed })
    }

    /// The names and hashes that identify the trial.
    pub fn identity(&self) -> Identity {
        Identity {
            scenario: self.scene.name.clone(),
            policy: self.program.name.clone(),
            true_tips: self.program.uses_true_tips(),
            world: self.world.kind.to_string(),
            seed: self.seed,
            mismatch: self.scene.mismatch.as_ref().map(MismatchIdentity::from),
            calibration: self.calibration(),
            friction: self.friction(),
            hash: Hashes {
                scenario: self.inputs.scenario_hash.clone(),
                policy: self.inputs.policy_hash.clone(),
                engine: short_hash(&engine_hash(&self.scene, self.world)),
            },
        }
    }
}

/// The first sixteen hexadecimal digits of a hash, enough to distinguish files.
#[must_use]
pub fn short_hash(hash: &[u8]) -> String {
    // Writing to a string cannot fail.
    hash.iter().take(8).fold(String::with_capacity(16), |mut text, byte| {
        let _ = write!(text, "{byte:02x}");
        text
    })
}
