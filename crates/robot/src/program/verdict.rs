//! `vibrissa-robot good` and `vibrissa-robot reject`

use std::process::ExitCode;

use clap::Args;

use super::command_line::print_result;
use super::drive::Error;
use super::store_options::TentativeOptions;

const GOOD_EXAMPLE: &str = "Example:\n  sudo -u vibrissa vibrissa-robot good";
const REJECT_EXAMPLE: &str =
    "Example:\n  sudo -u vibrissa vibrissa-robot reject --reason \"it loses the object at corners\"";

/// The arguments of `vibrissa-robot good`.
#[derive(Debug, Args)]
#[command(after_help = GOOD_EXAMPLE)]
pub(super) struct GoodArguments {
    #[command(flatten)]
    tentative: TentativeOptions,
}

/// The arguments of `vibrissa-robot reject`.
#[derive(Debug, Args)]
#[command(after_help = REJECT_EXAMPLE)]
pub(super) struct RejectArguments {
    #[command(flatten)]
    tentative: TentativeOptions,
    /// The reason, for the status
    #[arg(long, value_name = "TEXT", default_value = "it was given up by hand")]
    reason: String,
}

/// Marks the tentative machine good.
pub(super) fn good(arguments: &GoodArguments) -> Result<ExitCode, Error> {
    let (store, hash) = arguments.tentative.open()?;
    store.mark_good(hash)?;
    print_result(&format!("{hash} is good"));
    Ok(ExitCode::SUCCESS)
}

/// Gives the tentative machine up.
pub(super) fn reject(arguments: &RejectArguments) -> Result<ExitCode, Error> {
    let (store, hash) = arguments.tentative.open()?;
    store.reject(hash, &arguments.reason)?;
    print_result(&format!("{hash} is given up"));
    Ok(ExitCode::SUCCESS)
}
