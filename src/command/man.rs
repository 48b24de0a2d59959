//! `vibrissa setup man`

use std::path::PathBuf;

use clap::{Args, Command, CommandFactory};
use clap_mangen::Man;

use super::Arguments;
use super::exit::Exit;
use super::failure::Failure;
use super::output;
use super::trials::make_directory;
use vibrissa_text::file::CommandFiles;

const EXAMPLE: &str = "Example:\n  vibrissa setup man --out ~/.local/share/man/man1\n\n\
                       Exit status: 0 done; 2 unusable input; 3 internal error; 130 interrupted.";

/// The arguments of `vibrissa setup man`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLE)]
pub(super) struct ManArguments {
    /// Directory of the pages: one of the program, and one of every command, also of those within others
    #[arg(short, long, value_name = "DIR")]
    out: PathBuf,
}

pub(super) fn man(arguments: &ManArguments) -> Result<Exit, Failure> {
    make_directory(Some(&arguments.out))?;
    let mut program = Arguments::command();
    program.build();
    let mut pages = Vec::new();
    add_pages("vibrissa", &program, &mut pages);
    let mut files = CommandFiles::new();
    for (name, command) in pages {
        let mut page = Vec::new();
        Man::new(command).render(&mut page).map_err(Failure::Print)?;
        files.output("--out", &arguments.out.join(format!("{name}.1")))?.write(page)?;
    }
    output::result(format_args!("manual: {}", arguments.out.display()))?;
    Ok(Exit::Done)
}

/// Adds a command with the name of its page, and the visible commands within it.
fn add_pages(name: &str, command: &Command, pages: &mut Vec<(String, Command)>) {
    pages.push((name.to_owned(), command.clone().display_name(name.to_owned())));
    for inner in command.get_subcommands().filter(|inner| !inner.is_hide_set() && inner.get_name() != "help") {
        add_pages(&format!("{name}-{}", inner.get_name()), inner, pages);
    }
}
