//! `vibrissa-robot receive`

use std::io::{IsTerminal, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Args;

use super::drive::{Error, read_config};
use super::store_options::{KeyOptions, StoreOptions};
use crate::store::Keys;

const EXAMPLE: &str = "Example, on the computer of the developer:\n  vibrissa push vibrissa@robot thesis.machine";

/// The usual configuration of a robot.
const DEFAULT_CONFIG: &str = "/etc/vibrissa/array.yaml";

/// The arguments of `vibrissa-robot receive`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLE)]
pub(super) struct ReceiveArguments {
    #[command(flatten)]
    store: StoreOptions,
    #[command(flatten)]
    keys: KeyOptions,
    /// Configuration of the robot. A machine that was signed for another name is refused. By default
    /// /etc/vibrissa/array.yaml, if there is one
    #[arg(long, value_name = "FILE")]
    config: Option<PathBuf>,
}

/// Receives one push from standard input, and answers by one line on standard output.
pub(super) fn receive(arguments: &ReceiveArguments) -> Result<ExitCode, Error> {
    let input = std::io::stdin();
    if input.is_terminal() {
        return Err("a push arrives on standard input; run `vibrissa push HOST FILE.machine` on your computer".into());
    }
    let keys = Keys::from_folder(&arguments.keys.keys)?;
    let usual = Path::new(DEFAULT_CONFIG);
    let config = arguments.config.as_deref().or_else(|| usual.exists().then_some(usual));
    let store = arguments.store.open()?;
    let store = match config {
        Some(path) => store.of_robot(&read_config(path)?.0.name),
        None => store,
    };
    let answer = store.receive(input.lock(), &keys)?;
    // The sender may be gone. It pushes the machine again, and gets the same answer.
    let _ = writeln!(std::io::stdout(), "{answer}");
    Ok(ExitCode::SUCCESS)
}
