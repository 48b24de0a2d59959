//! `vibrissa replay`

use std::path::{Path, PathBuf};

use clap::Args;
use vibrissa_robot::recording;

use super::exit::Exit;
use super::failure::Failure;
use super::options::Format;
use super::output;
use crate::file::CommandFiles;
use crate::load::{self, LoadError};
use crate::report::replay_tables;
use crate::results::ReplayResult;

const EXAMPLE: &str = "Example:\n  vibrissa replay caught.mcap\n\nExit status: 0 every result is bit-identical; 1 a result differs; 2 unusable input; 3 internal error.";

/// The arguments of `vibrissa replay`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLE)]
pub(super) struct ReplayArguments {
    /// Recording. Or all parts of a recorded run
    #[arg(value_name = "FILE", required = true)]
    recording: Vec<PathBuf>,
    #[command(flatten)]
    format: Format,
}

pub(super) fn replay(arguments: &ReplayArguments) -> Result<Exit, Failure> {
    let paths = &arguments.recording;
    let named = paths.first().map_or(Path::new(""), PathBuf::as_path);
    let recording = load::recording(paths, &mut CommandFiles::new())?;
    let identity = recording.identity().clone();
    let replayed = recording::replay(recording).map_err(LoadError::recording(named))?;
    let result = ReplayResult::new(identity, &replayed);
    if result.is_cut {
        let (path, end) = (named.display(), result.end_s);
        output::message(format_args!("warning: {path}: its end is missing; it was replayed until {end:.3} s"));
    }
    output::document(arguments.format, &result, || replay_tables(&result))?;
    Ok(if result.difference.is_none() { Exit::Done } else { Exit::Unexpected })
}
