//! A request for a trial.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use sha2::{Digest, Sha256};
use vibrissa_runtime::machine::{Artifact, ParameterValue};
use vibrissa_runtime::rig::Rig;

use super::error::RequestError;
use super::input::{Input, PolicyInput};
use crate::load::{self, GivenMismatch, LoadError, Loaded, Policy, PolicyText};
use crate::run::Stopwatch;
use crate::trial::{Trial, TrialFault};
use vibrissa_text::diagnostic::{Diagnostic, Source};
use vibrissa_text::file::CommandFiles;
use vibrissa_world::scene::{Scene, WorldKind, WorldSetup};

/// A request for a trial: a scenario, and what replaces its policy, simulator and seed.
///
/// ```
/// use vibrissa_lab::built_in::SCENARIOS;
/// use vibrissa_lab::request::{Input, TrialRequest};
/// use vibrissa_world::scene::WorldKind;
/// let mut request = TrialRequest::new(Input::BuiltIn(&SCENARIOS[0]));
/// request.world = Some(WorldKind::QuasiStatic);
/// let prepared = request.prepare().unwrap();
/// assert_eq!(prepared.trial.scene.name, "disk");
/// assert_eq!(prepared.policy.artifact.program.name, "thesis");
/// ```
#[derive(Debug, Clone)]
pub struct TrialRequest {
    /// The scenario.
    pub scenario: Input,
    /// The policy. `None` for that of the scenario, or else the built-in one.
    pub policy: Option<PolicyInput>,
    /// Values of parameters of the policy.
    pub settings: Vec<(String, ParameterValue)>,
    /// A mismatch. The scenario's own keys precede it.
    pub mismatch: Option<Input>,
    /// Seed of the values that a mismatch draws from ranges.
    pub mismatch_seed: Option<u64>,
    /// True if control assumes the rig of the scene. Otherwise an array with a mismatch first calibrates itself by touches of a pin.
    pub uncalibrated: bool,
    /// The simulator. `None` for that of the scenario, or else the default.
    pub world: Option<WorldKind>,
    /// True if the simulator omits parts of the scene without effect.
    pub prune: bool,
    /// Seed of the sensor noise. `None` for that of the scenario.
    pub seed: Option<u64>,
    /// True if a seed that has no effect is no error.
    pub unused_seeds: bool,
}

/// A trial that is ready to run.
#[derive(Debug, Clone)]
pub struct PreparedTrial {
    /// The trial.
    pub trial: Trial,
    /// The policy.
    pub policy: PreparedPolicy,
}

/// A policy that is ready to run.
#[derive(Debug, Clone)]
pub struct PreparedPolicy {
    /// The machine. Its parameters are those of its text.
    pub artifact: Artifact,
    /// The text with those of the files that it uses. `None` for a compiled machine.
    pub text: Option<Source>,
    /// Warnings about probable mistakes in the text.
    pub warnings: Vec<Diagnostic>,
}

impl TrialRequest {
    /// The scenario with its own policy, simulator and seed.
    #[must_use]
    pub fn new(scenario: Input) -> Self {
        Self {
            scenario,
            policy: None,
            settings: Vec::new(),
            mismatch: None,
            mismatch_seed: None,
            uncalibrated: false,
            world: None,
            prune: true,
            seed: None,
            unused_seeds: false,
        }
    }

    /// Reads all files, compiles the policy and calibrates the array.
    ///
    /// # Errors
    /// [`RequestError`] if a file, a text or an option cannot be used.
    pub fn prepare(&self) -> Result<PreparedTrial, RequestError> {
        let mut files = CommandFiles::new();
        let mismatch = match &self.mismatch {
            None => GivenMismatch::read(None, self.mismatch_seed, &mut files)?,
            Some(Input::File(path)) => GivenMismatch::read(Some(path), self.mismatch_seed, &mut files)?,
            Some(Input::Text(source)) => GivenMismatch::of_text(source.clone(), self.mismatch_seed)?,
            Some(Input::BuiltIn(file)) => {
                GivenMismatch::of_text(Source::new(file.path, file.text), self.mismatch_seed)?
            }
        };
        let mismatch = mismatch.uncalibrated(self.uncalibrated);
        let (mut trial, policy) = self.prepare_in(&mismatch, &mut files, |_| ())?;
        if !self.unused_seeds {
            let scene = || std::iter::once(&trial.scene);
            mismatch.check_effect(scene()).map_err(LoadError::from)?;
            load::check_noise_seed(self.seed, scene()).map_err(LoadError::from)?;
        }
        if let Err(cause) = mismatch.calibrate(&mut trial) {
            return Err(TrialFault::Calibration { scenario: trial.inputs.scenario, cause }.into());
        }
        Ok(PreparedTrial { trial, policy: policy.into() })
    }

    /// The trial under a mismatch that has been read, and its policy. Its array is not yet calibrated. `compiled` receives the
    /// policy before its parameters are set.
    ///
    /// # Errors
    /// [`RequestError`] if a file, an option or the calibration is refused.
    pub fn prepare_in(
        &self,
        mismatch: &GivenMismatch,
        files: &mut CommandFiles,
        compiled: impl FnOnce(&Policy),
    ) -> Result<(Trial, Policy), RequestError> {
        let before = Stopwatch::start();
        let source = scenario_text(&self.scenario, files)?;
        let path = PathBuf::from(&source.name);
        let loaded = read_scene(&self.scenario, &source, files)?;
        let scene = &loaded.value;
        let policy = match (&self.policy, &self.scenario) {
            (Some(given), _) => given_policy(given, files)?,
            (None, Input::BuiltIn(_)) => load::built_in_policy(load::named_by_built_in(scene))?,
            (None, _) => load::policy_for(None, scene, &source, files)?,
        };
        compiled(&policy.value);
        let Loaded { value: policy, hash: policy_hash } = load::set(policy, &self.settings)?;
        let kind = self.world.or(scene.world).unwrap_or_default();
        let (program, world) = (Arc::new(policy.artifact.program.clone()), WorldSetup { kind, prune: self.prune });
        let mut trial = mismatch.trial((&path, loaded), (&program, policy_hash), world, 0)?;
        trial.inputs.preparation = before.elapsed();
        trial.seed = self.seed.unwrap_or(trial.seed);
        Ok((trial, policy))
    }
}

/// Reads a policy and sets parameters of it.
///
/// # Errors
/// [`RequestError`] if the policy or a value cannot be used.
pub fn policy(input: &PolicyInput, settings: &[(String, ParameterValue)]) -> Result<PreparedPolicy, RequestError> {
    Ok(load::set(given_policy(input, &mut CommandFiles::new())?, settings)?.value.into())
}

/// Reads a scenario alone.
///
/// # Errors
/// [`RequestError`] if the scenario cannot be used.
pub fn scene(input: &Input) -> Result<Scene, RequestError> {
    let mut files = CommandFiles::new();
    let source = scenario_text(input, &mut files)?;
    Ok(read_scene(input, &source, &mut files)?.value)
}

/// Reads a text that has a rig alone, with the keys that `rig` has in a scenario.
///
/// # Errors
/// [`RequestError`] if the rig cannot be used.
pub fn rig(input: &Input) -> Result<Rig, RequestError> {
    let mut files = CommandFiles::new();
    let source = match input {
        // The name of a built-in scenario is not that of a rig.
        Input::File(path) => load::read(path, &mut files)?,
        Input::Text(_) | Input::BuiltIn(_) => scenario_text(input, &mut files)?,
    };
    Ok(load::rig_in(&source, &mut files)?)
}

fn scenario_text(input: &Input, files: &mut CommandFiles) -> Result<Source, LoadError> {
    match input {
        Input::File(path) => load::scenario_text(path, files),
        Input::Text(source) => Ok(source.clone()),
        Input::BuiltIn(file) => Ok(Source::new(file.path, file.text)),
    }
}

fn read_scene(input: &Input, source: &Source, files: &mut CommandFiles) -> Result<Loaded<Scene>, LoadError> {
    match input {
        Input::BuiltIn(file) => load::built_in_scenario(file),
        Input::File(_) | Input::Text(_) => load::scenario_in(source, files),
    }
}

fn given_policy(input: &PolicyInput, files: &mut CommandFiles) -> Result<Loaded<Policy>, RequestError> {
    let policy = match input {
        PolicyInput::File(path) => load::policy(path, files)?,
        PolicyInput::Text(source) => load::policy_in(source, files)?,
        PolicyInput::BuiltIn(file) => load::built_in_policy(file)?,
        PolicyInput::Machine(artifact) => {
            let hash = Sha256::new_with_prefix(artifact.to_bytes()?);
            Loaded { value: Policy { artifact: (**artifact).clone(), text: None }, hash }
        }
    };
    match &policy.value.text {
        Some(text) if text.is_test_file => {
            Err(LoadError::TestFile { path: Path::new(&text.source.name).to_owned() }.into())
        }
        _ => Ok(policy),
    }
}

impl From<Policy> for PreparedPolicy {
    fn from(Policy { artifact, text }: Policy) -> Self {
        let (text, warnings) = match text {
            Some(PolicyText { source, warnings, .. }) => (Some(source), warnings),
            None => (None, Vec::new()),
        };
        Self { artifact, text, warnings }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]
    use super::*;
    use crate::built_in::{DEFAULT_POLICY, SCENARIOS};

    fn request() -> TrialRequest {
        TrialRequest { world: Some(WorldKind::QuasiStatic), ..TrialRequest::new(Input::BuiltIn(&SCENARIOS[0])) }
    }

    fn text(text: &str) -> Source {
        Source::new("mine", text)
    }

    #[test]
    fn a_seed_without_effect_is_an_error_unless_the_caller_says_so() {
        let fixed = || Some(Input::Text(text("stiffness: 5 %\n")));
        let seeded = |seed| TrialRequest { seed, ..request() };
        let drawn = |mismatch| TrialRequest { mismatch, mismatch_seed: Some(3), uncalibrated: true, ..request() };
        for request in [seeded(Some(3)), drawn(fixed()), drawn(None)] {
            let told = request.prepare().unwrap_err().to_string();
            assert!(told.contains("has no effect"), "{told}");
            assert!(TrialRequest { unused_seeds: true, ..request }.prepare().is_ok());
        }
        assert!(drawn(Some(Input::Text(text("stiffness: [1 %, 5 %]\n")))).prepare().is_ok());
    }

    #[test]
    fn a_machine_runs_as_its_text_does_and_has_a_hash_of_its_own() {
        let text = request().prepare().unwrap();
        let machine = PolicyInput::Machine(Box::new(text.policy.artifact.clone()));
        let machine = TrialRequest { policy: Some(machine), ..request() }.prepare().unwrap();
        assert_eq!(machine.trial.program, text.trial.program);
        assert_eq!(machine.trial.inputs.scenario_hash, text.trial.inputs.scenario_hash);
        assert_ne!(machine.trial.inputs.policy_hash, text.trial.inputs.policy_hash);
    }

    #[test]
    fn errors_are_told_as_the_program_prints_them() {
        let fails = |change: &dyn Fn(&mut TrialRequest)| {
            let mut request = request();
            change(&mut request);
            request.prepare().unwrap_err().to_string()
        };
        let told = fails(&|request| request.policy = Some(PolicyInput::Text(text("machine a  initial B"))));
        assert!(told.starts_with("error[P") && told.contains(" --> mine:1:"), "{told}");
        let told = fails(&|request| request.scenario = Input::Text(text("name: a\n")));
        assert!(told.starts_with("error[S") && told.contains(" --> mine:1:"), "{told}");
        let told = fails(&|request| request.scenario = Input::File("nowhere.yaml".into()));
        assert!(told.starts_with("cannot read nowhere.yaml: "), "{told}");
        let value = ParameterValue::parse("5 m").unwrap();
        let told = fails(&|request| request.settings = vec![("speed".to_owned(), value.clone())]);
        assert_eq!(told, "`speed` is a speed, not a length");
    }

    #[test]
    fn options_replace_those_of_the_scenario() {
        let mismatch = Some(Input::Text(text("stiffness: [-5 %, 5 %]\nsensor: {noise: 0.1 urad}\n")));
        let given = TrialRequest { mismatch, mismatch_seed: Some(7), uncalibrated: true, seed: Some(5), ..request() };
        let trial =
            TrialRequest { policy: Some(PolicyInput::BuiltIn(&DEFAULT_POLICY)), ..given }.prepare().unwrap().trial;
        assert_eq!((trial.seed, trial.world.kind), (5, WorldKind::QuasiStatic));
        assert_eq!(trial.scene.mismatch.unwrap().seed, Some(7));
        assert_eq!(trial.program.name, "vibrissa");
        assert!(request().prepare().unwrap().trial.scene.mismatch.is_none());
    }
}
