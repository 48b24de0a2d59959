//! `vibrissa fmt`

use std::path::{Path, PathBuf};

use clap::Args;
use similar::TextDiff;

use super::exit::Exit;
use super::failure::Failure;
use super::output;
use crate::diagnostic::{Source, printable};
use crate::file::{CommandFiles, replace};
use crate::load;
use crate::policy::format;

const EXAMPLE: &str = "Example:\n  vibrissa fmt --check policies/*.fsm\n\nExit status: 0 done and all expectations held; 1 an expectation failed; 2 unusable input; 3 internal error; 130 interrupted.";

/// The arguments of `vibrissa fmt`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLE)]
pub(super) struct FmtArguments {
    /// Policy files. `-` reads standard input and prints the formatted text
    #[arg(value_name = "POLICY", required = true)]
    policies: Vec<PathBuf>,
    /// Print the differences and change no file. The exit status is 1 if there are differences
    #[arg(long)]
    check: bool,
}

pub(super) fn fmt(arguments: &FmtArguments) -> Result<Exit, Failure> {
    let (mut exit, mut files) = (Exit::Done, CommandFiles::new());
    for path in &arguments.policies {
        exit = match (fmt_one(path, arguments.check, &mut files)?, exit) {
            (Exit::Done, exit) | (_, exit @ Exit::Unusable) => exit,
            (worse, _) => worse,
        };
    }
    Ok(exit)
}

fn fmt_one(path: &Path, check: bool, files: &mut CommandFiles) -> Result<Exit, Failure> {
    let standard = path == Path::new("-");
    let source = if standard { load::read_standard(files)? } else { load::policy_text(path, files)? };
    let formatted = match format(&source) {
        Ok(formatted) => formatted,
        Err(faults) => {
            output::diagnostics(&source, &faults);
            return Ok(Exit::Unusable);
        }
    };
    if check {
        output::text(difference(&source, &formatted))?;
        return Ok(if formatted == source.text { Exit::Done } else { Exit::Unexpected });
    }
    if standard {
        output::text(formatted)?;
    } else if formatted != source.text {
        // No other command writes to its input.
        replace(path, formatted.as_bytes()).map_err(Failure::rewrite(path))?;
        output::message(format_args!("formatted {}", source.name));
    }
    Ok(Exit::Done)
}

/// A unified diff from the current to the formatted text. Empty without a difference.
fn difference(source: &Source, formatted: &str) -> String {
    let name = printable(&source.name);
    TextDiff::from_lines(source.text.as_str(), formatted)
        .unified_diff()
        .header(&name, &format!("{name} (formatted)"))
        .to_string()
}
