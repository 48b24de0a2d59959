//! Mismatches.

use std::path::Path;

use sha2::{Digest, Sha256};

use super::text::read;
use super::{LoadError, Loaded};
use crate::built_in::PLAUSIBLE_MISMATCH;
use crate::diagnostic::Source;
use crate::file::CommandFiles;
use crate::mismatch::{Mismatch, MismatchError};
use crate::scenario::read_mismatch;
use crate::scene::Scene;

/// The mismatch that a command line adds to scenes.
#[derive(Default)]
pub(crate) struct GivenMismatch {
    /// The file.
    file: Option<Loaded<Mismatch>>,
    /// The seed of drawn values.
    seed: Option<u64>,
}

impl GivenMismatch {
    /// Reads the file at `path`. `seed` replaces the seeds of files and scenarios.
    pub(crate) fn read(path: Option<&Path>, seed: Option<u64>, files: &mut CommandFiles) -> Result<Self, LoadError> {
        let file = path.map(|path| mismatch(path, files)).transpose()?;
        Ok(Self { file, seed })
    }

    /// The mismatch of a text.
    pub(crate) fn of_text(source: Source, seed: Option<u64>) -> Result<Self, LoadError> {
        Ok(Self { file: Some(mismatch_in(source)?), seed })
    }

    /// The same, with the built-in plausible array if no file is given.
    pub(crate) fn or_plausible(self) -> Result<Self, LoadError> {
        let built_in = || mismatch_in(Source::new(PLAUSIBLE_MISMATCH.path, PLAUSIBLE_MISMATCH.text));
        Ok(Self { file: Some(self.file.map_or_else(built_in, Ok)?), ..self })
    }

    /// The hash of the file.
    pub(crate) fn hash(&self) -> Option<Sha256> {
        self.file.as_ref().map(|file| file.hash.clone())
    }

    /// The seed that replaces those of files and scenarios.
    pub(crate) fn seed(&self) -> Option<u64> {
        self.seed
    }

    /// Adds the mismatch to the `scene` of the run with this `number`, and to its `hash`. The array of each run has the
    /// sum of seed and number as its seed. A key of the scenario precedes the same key of the file.
    ///
    /// # Errors
    /// [`MismatchError`] if the mismatch does not fit to the rig.
    pub(crate) fn apply(&self, scene: &mut Scene, hash: &mut Sha256, number: u64) -> Result<(), MismatchError> {
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
        mismatch.check(&scene.rig)?;
        scene.mismatch = Some(mismatch);
        Ok(())
    }
}

/// Reads a file with a mismatch.
fn mismatch(path: &Path, files: &mut CommandFiles) -> Result<Loaded<Mismatch>, LoadError> {
    mismatch_in(read(path, files)?)
}

/// The mismatch of a text that has been read.
fn mismatch_in(source: Source) -> Result<Loaded<Mismatch>, LoadError> {
    match read_mismatch(&source) {
        Ok(value) => Ok(Loaded { value, hash: Sha256::new_with_prefix(&source.text) }),
        Err(faults) => Err(LoadError::Faults { source_text: Box::new(source), faults }),
    }
}
