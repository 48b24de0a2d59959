//! `vibrissa calibrate --pluck`

use std::path::Path;

use serde::Serialize;
use vibrissa_runtime::units::{Dimension, format_si};

use super::calibrate::CalibrateArguments;
use super::exit::Exit;
use super::failure::Failure;
use super::output;
use super::provenance::provenance;
#[cfg(feature = "recording")]
use super::replay::run_recording;
use vibrissa_lab::calibration::Pluck;
use vibrissa_lab::load;
#[cfg(feature = "recording")]
use vibrissa_lab::recording::SampledRun;
use vibrissa_lab::results::Document;
use vibrissa_text::file::CommandFiles;

/// The JSON output.
#[derive(Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(super) struct PluckDocument {
    whisker: String,
    /// Frequency of the first mode, without damping (Hz).
    first_mode_hz: f64,
    /// Time in which its amplitude decreases to 1/e (s).
    decay_s: f64,
    /// Share of the motion that the mode does not explain, as a ratio of root mean squares.
    misfit: f64,
}

impl Document for PluckDocument {
    const FORMAT: &'static str = "pluck";
}

/// Measures the first mode of a whisker from the recording of a pluck at `path`.
pub(super) fn calibrate_pluck(path: &Path, arguments: &CalibrateArguments) -> Result<Exit, Failure> {
    let mut files = CommandFiles::new();
    let (whisker, readings) = readings(path, arguments, &mut files)?;
    let pluck = Pluck::of(&readings).map_err(Failure::at(path))?;
    if arguments.format.json {
        let Pluck { first_mode, decay, misfit } = pluck;
        output::json(&provenance(), &PluckDocument { whisker, first_mode_hz: first_mode, decay_s: decay, misfit })?;
        return Ok(Exit::Done);
    }
    output::result(format_args!(
        "whiskers: {{{whisker}: {{first_mode: {}, decay: {}}}}}  # {:.0} % of the motion is another one",
        format_si(pluck.first_mode, Dimension::FREQUENCY),
        format_si(pluck.decay, Dimension::TIME),
        100.0 * pluck.misfit
    ))?;
    Ok(Exit::Done)
}

/// Name of the whisker, and its readings with their times.
fn readings(
    path: &Path,
    arguments: &CalibrateArguments,
    files: &mut CommandFiles,
) -> Result<(String, Vec<(f64, f64)>), Failure> {
    #[cfg(feature = "recording")]
    if let Some(run) = run_recording(path, files)? {
        let SampledRun { rig, samples, .. } = SampledRun::from(&run);
        let index = match &arguments.whisker {
            Some(name) => *rig.indices(std::slice::from_ref(name)).map_err(Failure::NoWhisker)?.first().unwrap_or(&0),
            None => 0,
        };
        let of_whisker =
            |sample: &vibrissa_runtime::signal::Sample| Some((sample.time, sample.whiskers.get(index)?.base_angle));
        let name = rig.whiskers.get(index).map_or_else(String::new, |whisker| whisker.name.clone());
        return Ok((name, samples.iter().flatten().filter_map(of_whisker).collect()));
    }
    let name = arguments.whisker.clone().unwrap_or_else(|| "r0".to_owned());
    Ok((name, load::timed_readings(path, files)?))
}
