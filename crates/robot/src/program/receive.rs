//! `vibrissa-robot receive`

use std::io::{IsTerminal, Write};
use std::process::ExitCode;

use clap::Args;

use super::drive::Error;
use super::store_options::{KeyOptions, StoreOptions};
use crate::store::Keys;

const EXAMPLE: &str = "Example, on the computer of the developer:\n  vibrissa push vibrissa@robot thesis.machine";

/// The arguments of `vibrissa-robot receive`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLE)]
pub(super) struct ReceiveArguments {
    #[command(flatten)]
    store: StoreOptions,
    #[command(flatten)]
    keys: KeyOptions,
}

/// Receives one push from standard input, and answers by one line on standard output.
pub(super) fn receive(arguments: &ReceiveArguments) -> Result<ExitCode, Error> {
    let input = std::io::stdin();
    if input.is_terminal() {
        return Err("a push arrives on standard input; run `vibrissa push HOST FILE.machine` on your computer".into());
    }
    let keys = Keys::from_folder(&arguments.keys.keys)?;
    let answer = arguments.store.open()?.receive(input.lock(), &keys)?;
    // The sender may be gone. It pushes the machine again, and gets the same answer.
    let _ = writeln!(std::io::stdout(), "{answer}");
    Ok(ExitCode::SUCCESS)
}
