//! `vibrissa inspect mjcf`

use std::path::PathBuf;

use clap::Args;

use super::exit::Exit;
use super::failure::Failure;
use super::output;
use vibrissa_lab::load;
use vibrissa_lab::trial::model;
use vibrissa_text::file::CommandFiles;

const EXAMPLE: &str = "Example:\n  vibrissa inspect mjcf scenarios/box.yaml > box.xml\n\nExit status: 0 done and all expectations held; 1 an expectation failed; 2 unusable input; 3 internal error; 130 interrupted.";

/// The arguments of `vibrissa inspect mjcf`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLE)]
pub(super) struct MjcfArguments {
    /// Scenario file or name of a built-in scenario such as `disk`
    #[arg(value_name = "SCENARIO")]
    scenario: PathBuf,
}

pub(super) fn mjcf(arguments: &MjcfArguments) -> Result<Exit, Failure> {
    let scene = load::scenario(&arguments.scenario, &mut CommandFiles::new())?.value;
    let model = model(&scene).map_err(Failure::at(&arguments.scenario))?;
    output::result(model.trim_end())?;
    Ok(Exit::Done)
}
