//! Scenarios and contact sets.

use std::path::{Path, PathBuf};

use sha2::{Digest, Sha256};
use vibrissa_runtime::calibration::{ContactSet, TouchReading};
use vibrissa_runtime::rig::Rig;

use super::sought::Sought;
use super::text::{SIZE_LIMIT, name, read, reason, text};
use super::{LoadError, Loaded};
use crate::built_in::TextFile;
use crate::calibration::{
    CountSet, SetsError, TouchFile, read_count_sets, read_sets, read_timed_readings, read_touch_file, read_touches,
};
use crate::family::Family;
use vibrissa_text::diagnostic::Source;
use vibrissa_text::file::CommandFiles;
use vibrissa_world::outline;
use vibrissa_world::scenario::{self, DrawnScenario};
use vibrissa_world::scene::Scene;

/// Reads a scenario with the files that it refers to. The hash is that of all of them.
///
/// # Errors
/// [`LoadError`] if a file cannot be read or its text has errors.
pub fn scenario(path: &Path, files: &mut CommandFiles) -> Result<Loaded<Scene>, LoadError> {
    scenario_in(&scenario_text(path, files)?, files)
}

/// Reads the text of a scenario. The path can also be the name of a built-in one, such as `disk`.
///
/// # Errors
/// [`LoadError`] if a file cannot be read or its text has errors.
pub fn scenario_text(path: &Path, files: &mut CommandFiles) -> Result<Source, LoadError> {
    let name = name(path)?;
    let bytes = Sought::Scenario.bytes(path, SIZE_LIMIT, files)?;
    Ok(Source::new(name, text(&bytes).map_err(LoadError::read(path))?))
}

/// Reads the family of a scenario whose values are drawn.
///
/// # Errors
/// [`LoadError`] if the file cannot be read, its text has errors, or it draws nothing.
pub fn family(path: &Path, files: &mut CommandFiles) -> Result<Family, LoadError> {
    drawn_scenes(&scenario_text(path, files)?)?.ok_or_else(|| LoadError::NoFamily { path: path.to_owned() })
}

/// The family of the text of a scenario. `None` if it draws nothing.
///
/// # Errors
/// [`LoadError`] if what it draws has errors.
pub fn drawn_scenes(source: &Source) -> Result<Option<Family>, LoadError> {
    match DrawnScenario::read(source) {
        Ok(scenario) => Ok(scenario.map(Family::written)),
        Err(faults) => Err(LoadError::Faults { source_text: Box::new(source.clone()), faults }),
    }
}

/// The scenario of a text that has been read, with the files that it refers to.
///
/// # Errors
/// [`LoadError`] if a file cannot be read or its text has errors.
pub fn scenario_in(source: &Source, files: &mut CommandFiles) -> Result<Loaded<Scene>, LoadError> {
    read_scenario(source, |name| outline_file(&beside(Path::new(&source.name), name), files))
}

/// The bytes of a file that a scenario names.
///
/// # Errors
/// The reason for which the file cannot be read.
pub fn outline_file(path: &Path, files: &mut CommandFiles) -> Result<Vec<u8>, String> {
    files.read(path, outline::SIZE_LIMIT).map_err(|cause| reason(path, &cause))
}

/// The path of a file whose name is relative to the file at `path`.
pub fn beside(path: &Path, name: impl AsRef<Path>) -> PathBuf {
    path.parent().unwrap_or(Path::new("")).join(name)
}

/// The rig of a text that has a rig alone, with the calibrations that it refers to.
///
/// # Errors
/// [`LoadError`] if a file cannot be read or its text has errors.
pub fn rig_in(source: &Source, files: &mut CommandFiles) -> Result<Rig, LoadError> {
    scenario::read_rig(source, &mut |name| outline_file(&beside(Path::new(&source.name), name), files))
        .map_err(|faults| LoadError::Faults { source_text: Box::new(source.clone()), faults })
}

/// A built-in scenario.
///
/// # Errors
/// [`LoadError`] if a file cannot be read or its text has errors.
pub fn built_in_scenario(file: &TextFile) -> Result<Loaded<Scene>, LoadError> {
    read_scenario(&Source::new(file.path, file.text), |_| Err("it is not built into the program".to_owned()))
}

fn read_scenario(
    source: &Source,
    mut file: impl FnMut(&str) -> Result<Vec<u8>, String>,
) -> Result<Loaded<Scene>, LoadError> {
    let mut hash = Sha256::new().chain_update(&source.text);
    let scene = scenario::read_with(source, &mut |name| {
        let bytes = file(name)?;
        hash.update([0]);
        hash.update(&bytes);
        Ok(bytes)
    });
    match scene {
        Ok(value) => Ok(Loaded { value, hash }),
        Err(faults) => Err(LoadError::Faults { source_text: Box::new(source.clone()), faults }),
    }
}

/// Reads measured contacts with base angles.
///
/// # Errors
/// [`LoadError`] if a file cannot be read or its text has errors.
pub fn contact_sets(path: &Path, files: &mut CommandFiles) -> Result<Vec<ContactSet>, LoadError> {
    sets(path, files, read_sets)
}

/// Reads measured contacts with counts of the sensor.
///
/// # Errors
/// [`LoadError`] if a file cannot be read or its text has errors.
pub fn count_sets(path: &Path, files: &mut CommandFiles) -> Result<Vec<CountSet>, LoadError> {
    sets(path, files, read_count_sets)
}

/// Reads measured touches of a known object, each with the name of its whisker.
///
/// # Errors
/// [`LoadError`] if a file cannot be read or its text has errors.
pub fn touches(path: &Path, files: &mut CommandFiles) -> Result<Vec<(String, TouchReading)>, LoadError> {
    sets(path, files, read_touches)
}

/// Reads measured touches as [`touches`] does, with those in which the whisker met nothing. There may be none.
///
/// # Errors
/// [`LoadError`] if a file cannot be read or its text has errors.
pub fn touch_file(path: &Path, files: &mut CommandFiles) -> Result<TouchFile, LoadError> {
    sets(path, files, read_touch_file)
}

/// Reads times (s) and base angles (rad) of one whisker.
///
/// # Errors
/// [`LoadError`] if a file cannot be read or its text has errors.
pub fn timed_readings(path: &Path, files: &mut CommandFiles) -> Result<Vec<(f64, f64)>, LoadError> {
    sets(path, files, read_timed_readings)
}

fn sets<T>(
    path: &Path,
    files: &mut CommandFiles,
    read_bytes: fn(&[u8]) -> Result<T, SetsError>,
) -> Result<T, LoadError> {
    let source = read(path, files)?;
    read_bytes(source.text.as_bytes()).map_err(|cause| LoadError::Sets { path: path.to_owned(), cause })
}
