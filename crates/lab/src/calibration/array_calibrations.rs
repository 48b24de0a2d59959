//! Calibrations of simulated arrays before their runs, each made once.

use std::collections::HashMap;
use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use vibrissa_runtime::calibration::Calibration;

use super::array_calibration::{ArrayCalibration, ArrayCalibrationError};
use super::touch_procedure::TouchLimits;
use super::whisker_touches::RefusedWhisker;
use crate::trial::{engine_version, short_hash};
use vibrissa_text::file::{Cache, hex};
use vibrissa_world::mismatch::Mismatch;
use vibrissa_world::scene::{Scene, SelfCalibration, WorldSetup};

/// The calibrations that simulated arrays make by their own touches before they run.
///
/// A calibration depends on the assumed rig, the true array, the physics, the simulator and the program alone. The hash of
/// all of them is its key. Each calibration is made once for each key, and is kept in the cache of the user for later
/// commands. Several threads and processes may use the same folder.
#[derive(Debug, Default)]
pub struct ArrayCalibrations {
    cache: Option<Cache>,
    made: Mutex<HashMap<Key, Arc<Slot>>>,
}

/// The hash of everything that a calibration depends on.
type Key = [u8; 32];

/// The calibration of one key. A thread that makes it holds the lock, so that others wait for it.
type Slot = Mutex<Option<Made>>;

/// A calibration, or the whisker that was refused.
#[derive(Debug, Clone)]
struct Made {
    whiskers: Result<Vec<Calibration>, RefusedWhisker>,
    cached: bool,
}

/// The content of a file of the cache.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Kept {
    whiskers: Vec<Calibration>,
}

/// Folder of the calibrations in the cache.
const FOLDER: &str = "calibrations";

impl ArrayCalibrations {
    /// Calibrations that are kept in the cache of the user.
    #[must_use]
    pub fn of_user() -> Self {
        Self { cache: Cache::of_user(FOLDER), ..Self::default() }
    }

    /// Calibrations that are kept in a folder.
    #[must_use]
    pub fn in_folder(folder: PathBuf) -> Self {
        Self { cache: Some(Cache::at(folder)), ..Self::default() }
    }

    /// True if [`calibrate`](Self::calibrate) gives the rig of a scene calibrations: its simulated array differs from it,
    /// and a whisker has no calibration.
    #[must_use]
    pub fn concern(scene: &Scene) -> bool {
        scene.mismatch.is_some() && scene.rig.whiskers.iter().any(|whisker| whisker.calibration.is_none())
    }

    /// Gives each whisker of the rig without a calibration that of the true array of the scene.
    ///
    /// The seed of the noise of the touches is that of the array. So an array has one calibration, whatever its runs.
    ///
    /// # Errors
    /// [`ArrayCalibrationError`] if the simulation fails, or with the first whisker that was refused.
    pub fn calibrate(&self, scene: &mut Scene, world: WorldSetup) -> Result<(), ArrayCalibrationError> {
        let Some(mismatch) = scene.mismatch.as_ref().filter(|_| Self::concern(scene)) else { return Ok(()) };
        let seed = if mismatch.is_drawn() { mismatch.seed.unwrap_or(0) } else { 0 };
        let limits = TouchLimits::default();
        let key = key(scene, mismatch, world, seed, &limits);
        let slot = Arc::clone(locked(&self.made).entry(key).or_default());
        let mut slot = locked(&slot);
        let kept = slot.take().or_else(|| self.kept(&key, scene.rig.whiskers.len()));
        let made = if let Some(kept) = kept {
            kept
        } else {
            let whiskers = match ArrayCalibration::run(scene, world, seed, &limits)?.calibrations() {
                Ok(whiskers) => Ok(whiskers),
                Err(ArrayCalibrationError::Refused(refused)) => Err(refused),
                Err(other) => return Err(other),
            };
            self.keep(&key, &whiskers);
            Made { whiskers, cached: false }
        };
        *slot = Some(made.clone());
        drop(slot);
        for (whisker, calibration) in scene.rig.whiskers.iter_mut().zip(made.whiskers?) {
            whisker.calibration.get_or_insert(calibration);
        }
        scene.self_calibration = Some(SelfCalibration { hash: short_hash(&key), cached: made.cached });
        Ok(())
    }

    /// The calibration that an earlier command has kept.
    fn kept(&self, key: &Key, whiskers: usize) -> Option<Made> {
        let Kept { whiskers: kept } = serde_json::from_slice(&self.cache.as_ref()?.read(&hex(key))?).ok()?;
        let is_sound = kept.len() == whiskers && kept.iter().all(|one| one.check().is_ok());
        is_sound.then_some(Made { whiskers: Ok(kept), cached: true })
    }

    /// Keeps a calibration for later commands. A run does not depend on it.
    fn keep(&self, key: &Key, whiskers: &Result<Vec<Calibration>, RefusedWhisker>) {
        if let (Some(cache), Ok(whiskers)) = (&self.cache, whiskers)
            && let Ok(text) = serde_json::to_vec(&Kept { whiskers: whiskers.clone() })
        {
            cache.write(&hex(key), &text);
        }
    }
}

/// The key of the calibration of a scene's array.
fn key(scene: &Scene, mismatch: &Mismatch, world: WorldSetup, seed: u64, limits: &TouchLimits) -> Key {
    let mut rig = scene.rig.clone();
    for whisker in &mut rig.whiskers {
        whisker.calibration = None;
    }
    // A text of the type `Debug` has every field, and numbers with all their digits. Another program may differ in any of
    // its functions, so its sources are a part of the key.
    let inputs = (&rig, mismatch.array(&rig), &scene.physics, world, seed, limits);
    let program = (engine_version(), env!("VIBRISSA_SOURCES"));
    Sha256::digest(format!("{program:?}{inputs:?}")).into()
}

/// Locks a value. Another thread that has panicked leaves a whole value.
fn locked<T>(value: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    value.lock().unwrap_or_else(PoisonError::into_inner)
}
