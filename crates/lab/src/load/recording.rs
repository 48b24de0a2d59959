//! Recordings of a robot's loop.

use std::fs::File;
use std::io::BufReader;
use std::path::PathBuf;

use vibrissa_robot::recording::{Part, Recording};

use super::LoadError;
use vibrissa_text::file::CommandFiles;

/// Opens the files of a recorded run.
///
/// # Errors
/// [`LoadError`] if a file cannot be read or its text has errors.
pub fn recording(paths: &[PathBuf], files: &mut CommandFiles) -> Result<Recording<BufReader<File>>, LoadError> {
    let mut part = |path: &PathBuf| {
        let file = files.open(path).map_err(LoadError::read(path))?;
        Part::open(BufReader::new(file)).map_err(LoadError::recording(path))
    };
    let parts = paths.iter().map(&mut part).collect::<Result<_, _>>()?;
    // All parts together have the error, so the first one stands for them.
    Recording::join(parts).map_err(LoadError::recording(paths.first().unwrap_or(&PathBuf::new())))
}
