//! `vibrissa setup completions`

use clap::{Args, CommandFactory};
use clap_complete::Shell;

use super::Arguments;
use super::exit::Exit;
use super::failure::Failure;
use super::output;

const EXAMPLE: &str = "Example:\n  vibrissa setup completions bash > ~/.local/share/bash-completion/completions/vibrissa\n\n\
                       Exit status: 0 done; 2 unusable input; 3 internal error; 130 interrupted.";

/// The arguments of `vibrissa setup completions`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLE)]
pub(super) struct CompletionsArguments {
    /// Shell
    #[arg(value_enum)]
    shell: Shell,
}

pub(super) fn completions(arguments: &CompletionsArguments) -> Result<Exit, Failure> {
    let mut script = Vec::new();
    clap_complete::generate(arguments.shell, &mut Arguments::command(), "vibrissa", &mut script);
    output::text(String::from_utf8_lossy(&script))?;
    Ok(Exit::Done)
}
