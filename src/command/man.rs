//! `vibrissa man`

use std::path::PathBuf;

use clap::{Args, CommandFactory};
use clap_mangen::Man;

use super::Arguments;
use super::exit::Exit;
use super::failure::Failure;
use super::output;
use super::trials::make_directory;
use crate::file::CommandFiles;

const EXAMPLE: &str = "Example:\n  vibrissa man --out ~/.local/share/man/man1\n\n\
                       Exit status: 0 done; 2 unusable input; 3 internal error; 130 interrupted.";

/// The arguments of `vibrissa man`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLE)]
pub(super) struct ManArguments {
    /// Directory of the pages: one of the program, and one of every command
    #[arg(short, long, value_name = "DIR")]
    out: PathBuf,
}

pub(super) fn man(arguments: &ManArguments) -> Result<Exit, Failure> {
    make_directory(Some(&arguments.out))?;
    let mut program = Arguments::command();
    program.build();
    let visible = program.get_subcommands().filter(|command| !command.is_hide_set() && command.get_name() != "help");
    let commands = visible.map(|command| {
        let name = format!("vibrissa-{}", command.get_name());
        (name.clone(), command.clone().display_name(name))
    });
    let pages: Vec<_> = std::iter::once(("vibrissa".to_owned(), program.clone())).chain(commands).collect();
    let mut files = CommandFiles::new();
    for (name, command) in pages {
        let mut page = Vec::new();
        Man::new(command).render(&mut page).map_err(Failure::Print)?;
        files.output("--out", &arguments.out.join(format!("{name}.1")))?.write(page)?;
    }
    output::result(format_args!("manual: {}", arguments.out.display()))?;
    Ok(Exit::Done)
}
