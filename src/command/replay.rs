//! `vibrissa replay`

#[cfg(feature = "recording")]
use std::io::{BufReader, Cursor, Read};
use std::path::{Path, PathBuf};

use clap::Args;
use vibrissa_robot::recording;

use super::exit::Exit;
use super::failure::Failure;
use super::options::Format;
use super::output;
#[cfg(feature = "recording")]
use super::{diff::explained, inspect::breakpoints};
use crate::file::CommandFiles;
use crate::load::{self, LoadError};
#[cfg(feature = "recording")]
use crate::recording::{RunRecording, compare_policies};
#[cfg(feature = "recording")]
use crate::report::difference_tables;
use crate::report::replay_tables;
use crate::results::ReplayResult;

const EXAMPLE: &str = "Examples:\n  vibrissa replay caught.mcap\n  vibrissa replay run.mcap --policy mine.fsm\n\nExit status: 0 every result is bit-identical; 1 a result differs; 2 unusable input; 3 internal error.";

/// The arguments of `vibrissa replay`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLE)]
pub(super) struct ReplayArguments {
    /// Recording. Or all parts of a recorded run
    #[arg(value_name = "FILE", required = true)]
    recording: Vec<PathBuf>,
    /// Give the samples of a recorded run to this policy as well, and report the first tick in which its command differs from that of
    /// the recorded policy
    #[cfg(feature = "recording")]
    #[arg(long, value_name = "FILE")]
    policy: Option<PathBuf>,
    #[command(flatten)]
    format: Format,
}

pub(super) fn replay(arguments: &ReplayArguments) -> Result<Exit, Failure> {
    let paths = &arguments.recording;
    let named = paths.first().map_or(Path::new(""), PathBuf::as_path);
    let mut files = CommandFiles::new();
    #[cfg(feature = "recording")]
    {
        if let Some(run) = run_recording(named, &mut files)? {
            return replay_run(named, &run, arguments, &mut files);
        }
        if arguments.policy.is_some() {
            return Err(Failure::OtherPolicy { path: named.to_owned() });
        }
    }
    let recording = load::recording(paths, &mut files)?;
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

/// Replays a simulated run, or compares its policy with another one.
#[cfg(feature = "recording")]
fn replay_run(
    path: &Path,
    run: &RunRecording,
    arguments: &ReplayArguments,
    files: &mut CommandFiles,
) -> Result<Exit, Failure> {
    let Some(policy) = &arguments.policy else {
        let result = crate::recording::replay(run).map_err(Failure::run_recording(path))?;
        output::document(arguments.format, &result, || replay_tables(&result))?;
        return Ok(if result.difference.is_none() { Exit::Done } else { Exit::Unexpected });
    };
    let own = run.policy().ok_or_else(|| Failure::NoRecordedText { path: path.to_owned() })?;
    let (own, other) = (breakpoints(own, &[])?, explained(policy, files)?);
    let difference = compare_policies(run, [&own, &other]).map_err(Failure::run_recording(path))?;
    output::document(arguments.format, &difference, || difference_tables(&difference))?;
    Ok(if difference.first.is_none() { Exit::Done } else { Exit::Unexpected })
}

/// The first bytes of a file, among which is the record that identifies it.
#[cfg(feature = "recording")]
const BEGINNING: u64 = 1 << 16;

/// Reads the recording of a simulated run. `None` if the file is no such recording.
#[cfg(feature = "recording")]
fn run_recording(path: &Path, files: &mut CommandFiles) -> Result<Option<RunRecording>, Failure> {
    let mut beginning = Vec::new();
    let mut file = files.open(path).map_err(LoadError::read(path))?;
    file.by_ref().take(BEGINNING).read_to_end(&mut beginning).map_err(LoadError::read(path))?;
    if !RunRecording::is_in(&beginning) {
        return Ok(None);
    }
    let whole = Cursor::new(beginning).chain(BufReader::new(file));
    RunRecording::read(whole).map(Some).map_err(Failure::run_recording(path))
}
