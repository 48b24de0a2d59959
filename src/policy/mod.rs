//! The compiler of the policy language: from text to a [`Program`].
//!
//! The way of a policy: `grammar` (pest, `grammar/fsm.pest`) and `parse` make the syntax tree of `ast`, `recover` as much of it as
//! can be had of a text with faults; `lower` checks names,
//! types and units and writes the machine's code; `analysis` looks at both for what is probably not meant; `format` lays texts
//! out. `builtins` is the one table of what the language offers, `docs/language.md`
//! its description for users.

mod analysis;
mod artifact;
mod ast;
mod builtins;
pub mod chart;
mod format;
mod grammar;
mod hint;
mod lower;
mod parse;
mod recover;
mod syntax_error;
mod types;

pub use format::format;

use crate::diagnostic::{Diagnostic, FAULT_LIMIT, Source};
use crate::machine::{Artifact, Program};

/// A policy that compiled.
#[derive(Debug, Clone, PartialEq)]
pub struct Compiled {
    /// The program, and where it comes from.
    pub artifact: Artifact,
    /// What is probably not meant, in the order of the text (the first fifty).
    pub warnings: Vec<Diagnostic>,
}

/// Compiles the text of a policy.
///
/// # Errors
/// Every fault that was found, in the order of their places: those of syntax, names, types, units and structure (the first
/// fifty), or cycles of transitions that a tick cannot end.
///
/// ```
/// use vibrissa::{diagnostic::Source, policy::compile};
/// let source = Source::new("still.fsm", "machine still  initial Still  state Still { stop }");
/// assert_eq!(&*compile(&source)?.states[0].name, "Still");
/// # Ok::<(), Vec<vibrissa::diagnostic::Diagnostic>>(())
/// ```
pub fn compile(source: &Source) -> Result<Program, Vec<Diagnostic>> {
    Ok(front(source)?.1.program)
}

/// Compiles the text of a policy, and looks for what is probably not meant.
///
/// # Errors
/// As [`compile`].
///
/// ```
/// use vibrissa::{diagnostic::Source, policy::compile_with_warnings};
/// let source = Source::new("still.fsm", "machine still  initial Still  state Still { stop }");
/// assert_eq!(compile_with_warnings(&source)?.warnings[0].message, "the state `Still` cannot be left");
/// # Ok::<(), Vec<vibrissa::diagnostic::Diagnostic>>(())
/// ```
pub fn compile_with_warnings(source: &Source) -> Result<Compiled, Vec<Diagnostic>> {
    let (file, lowered) = front(source)?;
    let warnings = analysis::warnings(&file, &lowered);
    Ok(Compiled { artifact: artifact::artifact(source, &file, lowered.program), warnings })
}

fn front(source: &Source) -> Result<(ast::File, lower::Lowered), Vec<Diagnostic>> {
    let (file, lowered) = checked(source)?;
    let errors = analysis::errors(&file, &lowered);
    if errors.is_empty() { Ok((file, lowered)) } else { Err(errors) }
}

/// The syntax tree of a text without fault, and what it compiles to.
fn checked(source: &Source) -> Result<(ast::File, lower::Lowered), Vec<Diagnostic>> {
    let mut parsed = recover::parse_all(source);
    let lowered = parsed.file.as_ref().map(lower::lower);
    let mut faults = match (parsed.file.take(), lowered) {
        (Some(file), Some(Ok(lowered))) if parsed.faults.is_empty() => return Ok((file, lowered)),
        (_, Some(Err(faults))) => faults,
        _ => Vec::new(),
    };
    faults.retain(|fault| !parsed.explains(source, fault));
    faults.append(&mut parsed.faults);
    faults.sort_by_key(|fault| fault.primary.span.start);
    faults.truncate(FAULT_LIMIT);
    Err(faults)
}

/// The statechart of a policy.
///
/// # Errors
/// Those of [`compile`]: only of a policy without fault can it be said what leads where.
///
/// ```
/// use vibrissa::{diagnostic::Source, policy::chart};
/// let source = Source::new("still.fsm", "machine still  initial Still  state Still { after 1 s -> Failure(\"late\") }");
/// assert_eq!(chart(&source)?.transitions[0].guard, chart::Guard::After("1 s".to_owned()));
/// # Ok::<(), Vec<vibrissa::diagnostic::Diagnostic>>(())
/// ```
pub fn chart(source: &Source) -> Result<chart::Chart, Vec<Diagnostic>> {
    Ok(chart::build(source, &checked(source)?.0))
}
