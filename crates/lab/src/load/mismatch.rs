//! Mismatches.

use std::path::Path;
use std::sync::Arc;

use sha2::{Digest, Sha256};
use vibrissa_runtime::machine::Program;

use super::seed::{WithoutEffect, check_mismatch_seed};
use super::sought::Sought;
use super::text::{SIZE_LIMIT, name, text};
use super::{LoadError, Loaded};
use crate::built_in::TextFile;
use crate::calibration::{ArrayCalibrationError, ArrayCalibrations};
use crate::trial::{Inputs, Trial, TrialFault, short_hash};
use vibrissa_text::diagnostic::Source;
use vibrissa_text::file::CommandFiles;
use vibrissa_world::mismatch::{Mismatch, MismatchError};
use vibrissa_world::scenario::read_mismatch;
use vibrissa_world::scene::{Scene, WorldSetup};

/// What the hash of a scenario has in addition if its array is not calibrated.
pub const UNCALIBRATED: &str = "\0uncalibrated";

/// The array of the runs of a command: the mismatch that is added to scenes, and the calibration of the true array.
pub struct GivenMismatch {
    /// The file.
    file: Option<Loaded<Mismatch>>,
    /// The seed of drawn values.
    seed: Option<u64>,
    /// The calibrations of true arrays. `None` if control assumes the rigs of the scenes.
    calibrations: Option<ArrayCalibrations>,
}

impl GivenMismatch {
    /// Reads the file at `path`, which can also be the name of a built-in mismatch. `seed` replaces the seeds of files and scenarios.
    ///
    /// # Errors
    /// [`LoadError`] if a file cannot be read or its text has errors.
    pub fn read(path: Option<&Path>, seed: Option<u64>, files: &mut CommandFiles) -> Result<Self, LoadError> {
        Ok(Self::new(path.map(|path| mismatch(path, files)).transpose()?, seed))
    }

    /// The mismatch of a text.
    pub(crate) fn of_text(source: Source, seed: Option<u64>) -> Result<Self, LoadError> {
        Ok(Self::new(Some(mismatch_in(source)?), seed))
    }

    fn new(file: Option<Loaded<Mismatch>>, seed: Option<u64>) -> Self {
        Self { file, seed, calibrations: Some(ArrayCalibrations::of_user()) }
    }

    /// The same without calibrations if `uncalibrated`.
    #[must_use]
    pub fn uncalibrated(self, uncalibrated: bool) -> Self {
        Self { calibrations: self.calibrations.filter(|_| !uncalibrated), ..self }
    }

    /// True if no file is given.
    #[must_use]
    pub fn is_none(&self) -> bool {
        self.file.is_none()
    }

    /// The same, with a built-in array if no file is given.
    ///
    /// # Errors
    /// [`LoadError`] if a file cannot be read or its text has errors.
    pub fn or_built_in(self, array: TextFile) -> Result<Self, LoadError> {
        let built_in = || mismatch_in(Source::new(array.path, array.text));
        Ok(Self { file: Some(self.file.map_or_else(built_in, Ok)?), ..self })
    }

    /// What the results of runs depend on, with names.
    pub fn inputs(&self) -> impl Iterator<Item = (String, String)> {
        let file = self.file.as_ref().map(|file| ("the mismatch", short_hash(&file.hash.clone().finalize())));
        let seed = self.seed.map(|seed| ("the seed of the mismatch", seed.to_string()));
        let calibration = if self.is_calibrated() { "by their own touches" } else { "none" };
        let inputs = file.into_iter().chain(seed).chain([("the calibration of arrays", calibration.to_owned())]);
        inputs.map(|(name, value)| (name.to_owned(), value))
    }

    /// Checks that the given options change the array of one of these scenes: the seed of the mismatch if one is given, and that
    /// arrays are not calibrated if they are not. A given mismatch, with ranges for the seed, is enough, so scenes that are drawn later need not be given.
    ///
    /// # Errors
    /// [`WithoutEffect`] if it does not.
    pub fn check_effect<'s>(&self, scenes: impl Iterator<Item = &'s Scene>) -> Result<(), WithoutEffect> {
        let scenes: Vec<&Scene> = scenes.collect();
        let differs = self.file.is_some() || scenes.iter().any(|scene| scene.mismatch.is_some());
        if !self.is_calibrated() && !differs {
            return Err(WithoutEffect::Uncalibrated);
        }
        check_mismatch_seed(self.seed, self.file.as_ref().map(|file| &file.value), scenes.into_iter())
    }

    /// True if true arrays are calibrated.
    pub(crate) fn is_calibrated(&self) -> bool {
        self.calibrations.is_some()
    }

    /// Gives control the calibration of the true array of a trial, if the array differs from the rig of the scene.
    ///
    /// # Errors
    /// [`ArrayCalibrationError`] if the array cannot be calibrated.
    pub fn calibrate(&self, trial: &mut Trial) -> Result<(), ArrayCalibrationError> {
        if ArrayCalibrations::concern(&trial.scene) {
            self.calibrate_scene(&mut trial.scene, trial.world)?;
            trial.assumed_rig = trial.scene.assumed_rig();
        }
        Ok(())
    }

    /// Gives the rig of a scene the calibration of its true array in a world.
    ///
    /// # Errors
    /// [`ArrayCalibrationError`] if the array cannot be calibrated.
    pub fn calibrate_scene(&self, scene: &mut Scene, world: WorldSetup) -> Result<(), ArrayCalibrationError> {
        self.calibrations.as_ref().map_or(Ok(()), |calibrations| calibrations.calibrate(scene, world))
    }

    /// The trial with this `number` of a scene, by the path of its scenario, under a program whose policy has this hash. The hash of
    /// the scenario is that of the scene with the mismatch. The array is not yet [calibrated](Self::calibrate).
    ///
    /// # Errors
    /// [`TrialFault::Mismatch`] if the mismatch does not fit to the rig.
    pub fn trial(
        &self,
        (path, scene): (&Path, Loaded<Scene>),
        (program, policy_hash): (&Arc<Program>, Sha256),
        world: WorldSetup,
        number: u64,
    ) -> Result<Trial, TrialFault> {
        let Loaded { value: mut scene, hash: mut scenario_hash } = scene;
        if let Err(cause) = self.apply(&mut scene, &mut scenario_hash, number) {
            return Err(TrialFault::Mismatch { scenario: path.to_owned(), cause });
        }
        let inputs = Inputs::new(path, scenario_hash, policy_hash);
        Ok(Trial { world, inputs, ..Trial::new(scene, Arc::clone(program)) })
    }

    /// Adds the mismatch to the `scene` of the run with this `number`, and to its `hash`. The array of each run has the
    /// sum of seed and number as its seed. A key of the scenario precedes the same key of the file. The array is not yet
    /// [calibrated](Self::calibrate).
    ///
    /// # Errors
    /// [`MismatchError`] if the mismatch does not fit to the rig.
    pub fn apply(&self, scene: &mut Scene, hash: &mut Sha256, number: u64) -> Result<(), MismatchError> {
        let Some(mut mismatch) = scene.mismatch.take().or_else(|| self.file.as_ref().map(|_| Mismatch::default()))
        else {
            return Ok(());
        };
        if let Some(file) = &self.file {
            mismatch.complete(&file.value);
            hash.update([0]);
            hash.update(file.hash.clone().finalize());
        }
        let seed = self.seed.or(mismatch.seed).unwrap_or(0).wrapping_add(number);
        if self.seed.is_some() || number > 0 {
            hash.update([0]);
            hash.update(seed.to_le_bytes());
        }
        mismatch.seed = Some(seed);
        // The world may be chosen later. MuJoCo refuses a light array when it is built.
        mismatch.check_without_inertia(&scene.rig)?;
        scene.mismatch = Some(mismatch);
        if !self.is_calibrated() && ArrayCalibrations::concern(scene) {
            hash.update(UNCALIBRATED);
        }
        Ok(())
    }
}

/// Reads a file with a mismatch.
fn mismatch(path: &Path, files: &mut CommandFiles) -> Result<Loaded<Mismatch>, LoadError> {
    let name = name(path)?;
    let bytes = Sought::Mismatch.bytes(path, SIZE_LIMIT, files)?;
    mismatch_in(Source::new(name, text(&bytes).map_err(LoadError::read(path))?))
}

/// The mismatch of a text that has been read.
fn mismatch_in(source: Source) -> Result<Loaded<Mismatch>, LoadError> {
    match read_mismatch(&source) {
        Ok(value) => Ok(Loaded { value, hash: Sha256::new_with_prefix(&source.text) }),
        Err(faults) => Err(LoadError::Faults { source_text: Box::new(source), faults }),
    }
}
