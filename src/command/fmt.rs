//! `vibrissa fmt`

use std::fmt::Write;
use std::path::{Path, PathBuf};

use clap::Args;
use similar::TextDiff;

use super::exit::Exit;
use super::failure::Failure;
use super::output;
use vibrissa_lab::load;
use vibrissa_language::format;
use vibrissa_text::diagnostic::{Source, printable};
use vibrissa_text::file::{CommandFiles, replace};

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

/// A unified diff from the current to the formatted text. Empty without a difference. What nobody sees is said or shown: other line
/// ends, blanks at the end of a line, and tabs.
fn difference(source: &Source, formatted: &str) -> String {
    let name = printable(&source.name);
    let text = source.text.replace("\r\n", "\n");
    let mut shown = String::new();
    let others = source.text.matches("\r\n").count();
    if others > 0 {
        let _ = writeln!(
            shown,
            "{name}: {others} {} with CR LF, as on Windows; `vibrissa fmt` writes LF alone",
            if others == 1 { "line ends" } else { "lines end" }
        );
    }
    let difference = TextDiff::from_lines(text.as_str(), formatted);
    let difference = difference.unified_diff().header(&name, &format!("{name} (formatted)")).to_string();
    for line in difference.split_inclusive('\n') {
        match line.strip_prefix('-').filter(|_| !line.starts_with("---")) {
            Some(removed) => {
                let _ = write!(shown, "-{}", with_blanks(removed));
            }
            None => shown.push_str(line),
        }
    }
    shown
}

/// A line with signs in place of the spaces at its end, of tabs, and of other blanks that look like them.
fn with_blanks(line: &str) -> String {
    let (text, end) = line.strip_suffix('\n').map_or((line, ""), |text| (text, "\n"));
    let visible = text.trim_end().len();
    let (head, blanks) = text.split_at(visible);
    let sign = |letter: char| match letter {
        '\t' => "\u{2192}".to_owned(),
        ' ' => "\u{b7}".to_owned(),
        letter => letter.escape_unicode().to_string(),
    };
    let blanks: String = blanks.chars().map(sign).collect();
    head.replace('\t', "\u{2192}") + &blanks + end
}
