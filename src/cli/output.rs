//! Printing. Results go to standard output, everything else to standard error.

use std::fmt::Display;
use std::io::{IsTerminal, Write, stderr, stdout};

use serde::Serialize;

use crate::diagnostic::{Colour, Diagnostic, Source, terminal};

use super::exit::Failure;

/// Prints a result. A reader that has gone away, such as `head`, is no fault.
pub(super) fn result(text: impl Display) {
    let _ = writeln!(stdout(), "{text}");
}

/// Prints a result that ends its own lines.
pub(super) fn text(text: impl Display) {
    let _ = write!(stdout(), "{text}");
}

/// Prints a result as JSON.
pub(super) fn json(value: &impl Serialize) -> Result<(), Failure> {
    result(serde_json::to_string_pretty(value)?);
    Ok(())
}

/// Prints a message.
pub(super) fn message(text: impl Display) {
    let _ = writeln!(stderr(), "{text}");
}

/// Prints what went wrong.
pub(super) fn error(text: impl Display) {
    message(format_args!("error: {text}"));
}

/// Prints the faults of a text.
pub(super) fn faults(source: &Source, faults: &[Diagnostic]) {
    let colour =
        if stderr().is_terminal() && std::env::var_os("NO_COLOR").is_none() { Colour::Ansi } else { Colour::Plain };
    let _ = write!(stderr(), "{}", terminal(source, faults, colour));
}
