//! Printing. Results go to standard output, everything else to standard error.

use std::fmt::Display;
use std::io::{ErrorKind, IsTerminal, Write, stderr, stdout};
use std::path::Path;

use vibrissa_runtime::machine::Program;
use vibrissa_runtime::rig::Rig;

use vibrissa_lab::report::Table;
use vibrissa_lab::results::{CalibrationIdentity, Document, Provenance};
use vibrissa_text::diagnostic::{Colour, Diagnostic, Source, printable, printable_json, terminal};

use super::failure::Failure;
use super::options::Format;
use vibrissa_lab::load::{Policy, PolicyText};

/// Prints a result and ends its line.
pub(super) fn result(text: impl Display) -> Result<(), Failure> {
    written(&format!("{}\n", printable(&text.to_string())))
}

/// Prints tables, one below the other. They have all columns if `wide` is true, else those that fit on a line.
pub(super) fn tables(tables: &[Table], wide: bool) -> Result<(), Failure> {
    let texts: Vec<String> = tables.iter().map(|table| if wide { table.wide() } else { table.fitted() }).collect();
    result(texts.join("\n\n"))
}

/// Prints a text without changes, except for terminals, which would interpret control characters. A closed pipe is no
/// error. A full disk is one.
pub(super) fn text(text: impl Display) -> Result<(), Failure> {
    let text = text.to_string();
    written(&if stdout().is_terminal() { printable(&text) } else { text.into() })
}

fn written(text: &str) -> Result<(), Failure> {
    match stdout().write_all(text.as_bytes()) {
        Err(cause) if cause.kind() != ErrorKind::BrokenPipe => Err(Failure::Print(cause)),
        _ => Ok(()),
    }
}

/// Prints documents as a JSON list, or the tables of `tables`.
pub(super) fn documents<T: AsRef<[Table]>>(
    format: Format,
    provenance: &Provenance,
    documents: &[impl Document],
    tables: impl FnOnce() -> T,
) -> Result<(), Failure> {
    if format.json { json_list(provenance, documents) } else { self::tables(tables().as_ref(), format.wide) }
}

/// Prints a document as JSON, or the tables of `tables`.
pub(super) fn document<T: AsRef<[Table]>>(
    format: Format,
    provenance: &Provenance,
    document: &impl Document,
    tables: impl FnOnce() -> T,
) -> Result<(), Failure> {
    if format.json { json(provenance, document) } else { self::tables(tables().as_ref(), format.wide) }
}

/// Prints a document as JSON.
pub(super) fn json(provenance: &Provenance, document: &impl Document) -> Result<(), Failure> {
    written(&format!("{}\n", printable_json(&serde_json::to_string_pretty(&document.versioned(Some(provenance)))?)))
}

/// Prints documents as a list in JSON.
pub(super) fn json_list(provenance: &Provenance, documents: &[impl Document]) -> Result<(), Failure> {
    written(&format!("{}\n", printable_json(&list(provenance, documents)?)))
}

/// Documents as a list in JSON.
pub(super) fn list(provenance: &Provenance, documents: &[impl Document]) -> serde_json::Result<String> {
    let documents: Vec<_> = documents.iter().map(|document| document.versioned(Some(provenance))).collect();
    serde_json::to_string_pretty(&documents)
}

/// A document as a line of JSON, with its line end. The first line of a file has the origin of all of them.
pub(super) fn json_line(provenance: Option<&Provenance>, document: &impl Document) -> serde_json::Result<String> {
    Ok(serde_json::to_string(&document.versioned(provenance))? + "\n")
}

/// Prints a message.
pub(super) fn message(text: impl Display) {
    let _ = writeln!(stderr(), "{}", printable(&text.to_string()));
}

/// Prints an error.
pub(super) fn error(text: impl Display) {
    message(format_args!("error: {text}"));
}

/// Prints the diagnostics of a text.
pub(super) fn diagnostics(source: &Source, diagnostics: &[Diagnostic]) {
    let colour =
        if stderr().is_terminal() && std::env::var_os("NO_COLOR").is_none() { Colour::Ansi } else { Colour::Plain };
    let _ = write!(stderr(), "{}", terminal(source, diagnostics, colour));
}

/// Warns if a policy does not allow the rates of a scenario's rig. The run is possible, and shows the effect of the rates.
pub(super) fn warn_of_rates(scenario: &Path, rig: &Rig, program: &Program) {
    if let Err(unmet) = program.needs.check_rates(rig.sensing.control_rate, rig.sensing.sample_rate) {
        message(format_args!("warning: {}: {unmet}; results may differ", scenario.display()));
    }
}

/// Says which calibrations the arrays of some runs have, each once.
pub(super) fn calibrations<'c>(calibrations: impl Iterator<Item = &'c CalibrationIdentity>) {
    let mut different: Vec<&CalibrationIdentity> = Vec::new();
    for calibration in calibrations {
        if !different.contains(&calibration) {
            different.push(calibration);
        }
    }
    if different.len() <= CALIBRATIONS_SHOWN {
        for calibration in different {
            message(format_args!("the array is {calibration}"));
        }
    } else {
        let cached = different.iter().filter(|calibration| calibration.cached).count();
        message(format_args!("the runs have {} calibrations, {cached} of them cached", different.len()));
    }
}

/// Number of different calibrations that are printed one by one.
const CALIBRATIONS_SHOWN: usize = 3;

/// Prints the warnings of a policy, and says if only a simulator can run it.
pub(super) fn warnings(policy: &Policy) {
    note_true_tips(&policy.artifact.program);
    if let Some(PolicyText { source, warnings, .. }) = &policy.text {
        diagnostics(source, warnings);
    }
}

/// Says that a program uses true tips, if it does.
fn note_true_tips(program: &Program) {
    if program.uses_true_tips() {
        message(format_args!(
            "note: {} uses true tips (`by truth`), so results are without errors of perception, and no robot can run it",
            program.name
        ));
    }
}
