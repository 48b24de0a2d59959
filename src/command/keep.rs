//! `vibrissa inspect keep`

use std::path::{Path, PathBuf};

use clap::Args;
use vibrissa_robot::recording::{Recording, first_stop, keep as keep_until, replay};

use super::exit::Exit;
use super::failure::Failure;
use super::output;
use super::values::parse_time;
use vibrissa_lab::load::{self, LoadError};
use vibrissa_text::file::CommandFiles;

const EXAMPLE: &str = "Example:\n  vibrissa inspect keep run-00012-00000.mcap --at 12.3s --out caught.mcap\n\nExit status: 0 done; 1 the kept recording does not replay bit for bit on this computer; 2 unusable input; 3 internal error.";

/// Time (s) after the stop that is kept, so that the loop recovers from most faults within it.
const AFTER: f64 = 1.0;

/// The arguments of `vibrissa inspect keep`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLE)]
pub(super) struct KeepArguments {
    /// Recording. Or all parts of a recorded run
    #[arg(value_name = "FILE", required = true)]
    recording: Vec<PathBuf>,
    /// Time since the start of the recorded program, such as "12.3s". One second more is kept. By default, it is the
    /// time of the first stop by a fault
    #[arg(long, value_name = "TIME", value_parser = parse_time)]
    at: Option<f64>,
    /// File to write. By default, the name of the recording with `-kept`, in the current directory
    #[arg(short, long, value_name = "FILE")]
    out: Option<PathBuf>,
}

pub(super) fn keep(arguments: &KeepArguments) -> Result<Exit, Failure> {
    let paths = &arguments.recording;
    let named = paths.first().map_or(Path::new(""), PathBuf::as_path);
    let mut files = CommandFiles::new();
    let recording = load::recording(paths, &mut files)?;
    let file = files.output("--out", &arguments.out.clone().unwrap_or_else(|| kept_name(named)))?;
    let (at, recording) = if let Some(at) = arguments.at {
        (at, recording)
    } else {
        let stop_ns = first_stop(recording).map_err(LoadError::recording(named))?;
        let reason = "no fault has stopped the robot in this recording; give a time with --at";
        (stop_ns.ok_or_else(|| Failure::at(named)(reason))? as f64 * 1e-9, load::recording(paths, &mut files)?)
    };
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "`as` saturates")]
    let [at_ns, until_ns] = [at, at + AFTER].map(|time| (time * 1e9) as u64);
    let (bytes, kept) = keep_until(recording, until_ns, Vec::new()).map_err(Failure::at(named))?;
    let end = kept.end_ns as f64 * 1e-9;
    if kept.end_ns < at_ns {
        return Err(Failure::at(named)(format!("the recording ends at {end:.3} s; give an earlier time with --at")));
    }
    let kept_recording = Recording::open(bytes.as_slice()).map_err(LoadError::recording(named))?;
    let difference = replay(kept_recording).map_err(LoadError::recording(named))?.difference;
    let (out, size) = (file.path().display().to_string(), bytes.len());
    file.write(&bytes)?;
    output::result(format_args!("{out}: {} steps until {end:.3} s, {size} bytes", kept.steps))?;
    let Some(difference) = difference else { return Ok(Exit::Done) };
    let (field, time) = (&difference.field, difference.time_ns as f64 * 1e-9);
    output::message(format_args!(
        "the kept recording does not replay bit for bit on this computer: `{field}` differs at {time:.3} s"
    ));
    Ok(Exit::Unexpected)
}

/// The name of the kept part of a recording.
fn kept_name(recording: &Path) -> PathBuf {
    let mut name = recording.file_stem().unwrap_or_default().to_owned();
    name.push("-kept.mcap");
    name.into()
}
