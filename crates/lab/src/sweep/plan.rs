//! A sweep with the files that it names: everything that its runs depend on.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use sha2::{Digest, Sha256};
use vibrissa_runtime::machine::{ParameterValue, Program};
use vibrissa_runtime::units::Dimension;

use super::{Header, ScenesOf, Shard, Sweep, SweepRun, SweepScenes};
use crate::family::{Family, NoDraw, Values};
use crate::load::{self, GivenMismatch, LoadError, Loaded, Policy, Sought, beside, outline_file, with_settings};
use crate::trial::{Trial, TrialFault, check_world, engine_version, short_hash};
use vibrissa_declare::catalogue::common::SPEED;
use vibrissa_text::diagnostic::Source;
use vibrissa_text::file::CommandFiles;
use vibrissa_world::scene::{FileReference, WorldSetup};

/// A sweep that is ready to run.
pub struct Plan {
    path: PathBuf,
    source: Source,
    /// The sweep.
    pub sweep: Sweep,
    policies: Vec<Loaded<Program>>,
    /// Where its scenes come from, in their order.
    scenes: Vec<SceneSource>,
    /// The content of the files that scenarios name, by path, or the reason why a file cannot be read.
    files: BTreeMap<PathBuf, Result<Vec<u8>, String>>,
    inputs: BTreeMap<String, String>,
    prune: bool,
    mismatch: GivenMismatch,
}

/// Where scenes come from.
enum SceneSource {
    /// A family that the program has, or that a file describes. Names in its scenes are relative to the path.
    Family { family: Family, path: PathBuf },
    /// The text of a scenario.
    Scenario(Source),
}

impl Plan {
    /// Reads a sweep and the files that it names. Its runs are pruned if `prune`, and have the `mismatch`.
    ///
    /// # Errors
    /// [`TrialFault`] if a file cannot be used.
    pub fn read(
        path: &Path,
        prune: bool,
        mismatch: GivenMismatch,
        files: &mut CommandFiles,
    ) -> Result<Self, TrialFault> {
        let source = load::read(path, files)?;
        let sweep = match Sweep::from_yaml(&source) {
            Ok(sweep) => sweep,
            Err(faults) => return Err(TrialFault::Load(LoadError::Faults { source_text: Box::new(source), faults })),
        };
        let mut inputs = BTreeMap::from([("the program".to_owned(), engine_version())]);
        if !prune {
            inputs.insert("pruning".to_owned(), "none".to_owned());
        }
        inputs.extend(mismatch.inputs());
        let mut hashed = |kind: &str, path: &Path, hash: Sha256| {
            inputs.insert(format!("{kind} {}", path.display()), short_hash(&hash.finalize()));
        };
        let mut policies = Vec::new();
        for file in &sweep.policies {
            let policy = load::program(&Sought::Policy.beside(path, &file.path), files)
                .map_err(LoadError::named_in(&source, file))?;
            hashed("policy", &file.path, policy.hash.clone());
            policies.push(policy);
        }
        let mut scenes = Vec::new();
        for SweepScenes { of, .. } in &sweep.scenes {
            let file = match of {
                ScenesOf::Scenario(file) => file,
                ScenesOf::Family(family) => {
                    scenes.push(SceneSource::Family { family: family.clone(), path: path.to_owned() });
                    continue;
                }
            };
            let text = load::scenario_text(&Sought::Scenario.beside(path, &file.path), files)
                .map_err(LoadError::named_in(&source, file))?;
            hashed("scenario", &file.path, Sha256::new_with_prefix(&text.text));
            scenes.push(match load::drawn_scenes(&text)? {
                Some(family) => SceneSource::Family { family, path: PathBuf::from(&text.name) },
                None => SceneSource::Scenario(text),
            });
        }
        let path = path.to_owned();
        let mut plan = Self { path, source, sweep, policies, scenes, files: BTreeMap::new(), inputs, prune, mismatch };
        plan.read_files(files);
        Ok(plan)
    }

    /// Reads the files that scenes and values name. They are kept, so that all runs have the same.
    fn read_files(&mut self, read: &mut CommandFiles) {
        let mut files = BTreeMap::new();
        for run in self.sweep.samples().filter(|run| run.policy == 0) {
            let Ok((path, text, _)) = self.scenario(&run) else { continue };
            // Its errors are reported when its run is prepared.
            let _ = run.scene(&text, &self.source, &mut |name| {
                let path = beside(&path, name);
                let bytes = outline_file(&path, read);
                files.insert(path, bytes.clone());
                bytes
            });
        }
        for (path, bytes) in &files {
            let version = match bytes {
                Ok(bytes) => short_hash(&Sha256::digest(bytes)),
                Err(reason) => reason.clone(),
            };
            self.inputs.insert(format!("file {}", path.display()), version);
        }
        self.files = files;
    }

    /// The header of the results of a part.
    pub fn header(&self, shard: Shard) -> Header {
        let (sweep, text) = (self.sweep.name.clone(), self.source.text.clone());
        Header { sweep, shard, text, inputs: self.inputs.clone() }
    }

    /// Reads the policies once more with the analysis that finds warnings. It takes most of the time of a compilation.
    ///
    /// # Errors
    /// [`TrialFault`] if a policy cannot be used.
    pub fn analysed_policies(&self, files: &mut CommandFiles) -> Result<Vec<Policy>, TrialFault> {
        let read =
            |file: &FileReference| Ok(load::policy(&Sought::Policy.beside(&self.path, &file.path), files)?.value);
        self.sweep.policies.iter().map(read).collect()
    }

    /// Prepares one run of every kind, so that all errors are reported before the first run.
    ///
    /// `note` receives remarks about the sweep.
    ///
    /// # Errors
    /// [`TrialFault`] if a run cannot begin.
    pub fn check(&self, mut note: impl FnMut(String)) -> Result<(), TrialFault> {
        let mut noted = BTreeSet::new();
        let mut scenes = Vec::new();
        for run in self.sweep.samples() {
            let trial = self.uncalibrated_trial(&run)?;
            check_world(trial.world.kind)
                .map_err(|cause| TrialFault::Execute { scenario: trial.inputs.scenario.clone(), cause })?;
            let is_same = matches!(self.scenes[run.scenes], SceneSource::Scenario(_)) && !trial.scene.is_random();
            if is_same && run.scenes().trials > 1 && noted.insert(run.scenes) {
                let name = run.scenes().name();
                note(format!("{name}: without noise all trials are the same run"));
            }
            if let Err(cause) = trial.control() {
                return Err(LoadError::at(&self.source, run.unfit(None, &cause.to_string())).into());
            }
            scenes.push(trial.scene);
        }
        Ok(self.mismatch.check_effect(scenes.iter()).map_err(LoadError::from)?)
    }

    /// The trial of a run. Its array is calibrated.
    ///
    /// # Errors
    /// [`TrialFault`] if it cannot be made.
    pub fn trial(&self, run: &SweepRun<'_>) -> Result<Trial, TrialFault> {
        let mut trial = self.uncalibrated_trial(run)?;
        match self.mismatch.calibrate(&mut trial) {
            Ok(()) => Ok(trial),
            Err(cause) => Err(TrialFault::Calibration { scenario: trial.inputs.scenario, cause }),
        }
    }

    fn uncalibrated_trial(&self, run: &SweepRun<'_>) -> Result<Trial, TrialFault> {
        let policy = &self.policies[run.policy];
        let mut program = policy.value.clone();
        let mut settings = Vec::new();
        for (name, value, span) in run.parameters() {
            let set = program.set_value(name, value);
            let value = set.map_err(|cause| LoadError::at(&self.source, run.unfit(Some(span), &cause.to_string())))?;
            settings.push((name, value));
        }
        let (path, text, drawn_speed) = self.scenario(run)?;
        if let Some(speed) = drawn_speed {
            let set = program.set("speed", speed, Dimension::SPEED);
            set.map_err(|cause| LoadError::at(&self.source, run.unfit(None, &cause.to_string())))?;
            settings.push(("speed", speed));
        }
        let mut scenario_hash = Sha256::new_with_prefix(&text.text);
        let scene = run.scene(&text, &self.source, &mut |name| {
            let bytes = self.file(&path, name)?;
            scenario_hash.update([0]);
            scenario_hash.update(&bytes);
            Ok(bytes)
        });
        let scene =
            scene.map_err(|(source_text, faults)| TrialFault::Load(LoadError::Faults { source_text, faults }))?;
        let changes = run.settings().map(|(name, value)| format!("\0{name}={value}"));
        let hash = changes.fold(scenario_hash, Sha256::chain_update);
        let policy_hash = with_settings(policy.hash.clone(), settings.into_iter());
        let seed = match &self.scenes[run.scenes] {
            SceneSource::Family { .. } => scene.seed,
            SceneSource::Scenario(_) => run.scenes().seed.unwrap_or(scene.seed).wrapping_add(run.trial),
        };
        let world = WorldSetup { kind: scene.world.unwrap_or_default(), prune: self.prune };
        let (path, scene) = (Path::new(&text.name), Loaded { value: scene, hash });
        let trial = self.mismatch.trial((path, scene), (&Arc::new(program), policy_hash), world, run.trial)?;
        Ok(Trial { seed, ..trial })
    }

    /// The path and text of a run's scenario, and the random speed (m/s) of a scene of a family. Names in the text are
    /// relative to the path.
    fn scenario(&self, run: &SweepRun<'_>) -> Result<(PathBuf, Source, Option<f64>), TrialFault> {
        let scenes = run.scenes();
        match &self.scenes[run.scenes] {
            SceneSource::Scenario(text) => Ok((PathBuf::from(&text.name), text.clone(), None)),
            SceneSource::Family { family, path } => {
                let speed = run.parameters().find(|(name, ..)| *name == SPEED.name);
                // Any other value than a quantity is refused when it is set.
                let speed = speed.and_then(|(_, speed, span)| match speed {
                    ParameterValue::Quantity(speed) => Some((SPEED.name, speed.value_si, span)),
                    ParameterValue::Choice(_) => None,
                });
                let given: Vec<_> = run.family_values().chain(speed).collect();
                let values: Values = given.iter().map(|&(name, value, _)| (name, value)).collect();
                let draw = family.draw_with(scenes.family_seed(), run.trial, &values);
                let draw = draw.map_err(|fault| match (fault, given.first()) {
                    (NoDraw::Given { reason, .. }, Some(&(.., span))) => {
                        TrialFault::Load(LoadError::at(&self.source, run.no_scene(span, &reason)))
                    }
                    (fault, _) => TrialFault::Draw(fault),
                })?;
                let drawn_speed = speed.is_none().then_some(draw.speed);
                Ok((path.clone(), Source::new(draw.scene.name, draw.text), drawn_speed))
            }
        }
    }

    /// The content of the file that the scenario at `scenario` calls `name`, as it was when the sweep was read.
    fn file(&self, scenario: &Path, name: &str) -> Result<Vec<u8>, String> {
        let path = beside(scenario, name);
        // If several values change one part of a scenario, a run may name a file that no sample names.
        self.files.get(&path).cloned().unwrap_or_else(|| outline_file(&path, &mut CommandFiles::new()))
    }
}
