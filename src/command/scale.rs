//! `vibrissa study scale`

use clap::Args;

use super::exit::Exit;
use super::failure::Failure;
use super::options::Format;
use super::output;
use super::progress::Progress;
use super::provenance::{provenance, simulator};
use super::values::parse_repeats;
use vibrissa_lab::report::scale_tables;
use vibrissa_lab::study::scale::{ScaleError, axes, measure, steps};

const EXAMPLE: &str = "Example:\n  vibrissa study scale --repeats 5\n\nExit status: 0 done; 2 unusable input; 3 internal error; 130 interrupted.";

/// The arguments of `vibrissa study scale`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLE)]
pub(super) struct ScaleArguments {
    /// Number of measurements of every size, from 1 to 1000. The figures are medians
    #[arg(long, value_name = "N", default_value = "3", allow_negative_numbers = true, value_parser = parse_repeats)]
    repeats: usize,
    #[command(flatten)]
    format: Format,
}

pub(super) fn scale(arguments: &ScaleArguments) -> Result<Exit, Failure> {
    let program = std::env::current_exe().map_err(|cause| ScaleError::Job(cause.to_string()))?;
    let axes = axes();
    let mut progress = Progress::new(steps(&axes, arguments.repeats));
    let scale = measure(&axes, &program, arguments.repeats, |measured| progress.done(measured))?;
    progress.finish();
    let mut provenance = provenance();
    for cost in &scale.sweeps {
        provenance.add_simulator(simulator(&cost.simulator));
    }
    output::document(arguments.format, &provenance, &scale, || scale_tables(&scale))?;
    Ok(Exit::Done)
}
