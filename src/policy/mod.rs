//! The compiler of the policy language: from text to a [`Program`].
//!
//! The way of a policy: `grammar` (pest, `grammar/fsm.pest`) and `parse` make the syntax tree of `ast`; `lower` checks names,
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
pub mod index;
mod lower;
mod parse;
mod syntax_error;
mod types;

pub use format::format;

use crate::diagnostic::{Diagnostic, Source};
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
/// Every fault that was found, in the order of their places: one of syntax, or those of names, types, units and structure
/// (the first fifty), or cycles of transitions that a tick cannot end.
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
    let file = parse::parse(source).map_err(|diagnostic| vec![*diagnostic])?;
    let lowered = lower::lower(&file)?;
    let errors = analysis::errors(&file, &lowered);
    if errors.is_empty() { Ok((file, lowered)) } else { Err(errors) }
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
    let file = parse::parse(source).map_err(|diagnostic| vec![*diagnostic])?;
    lower::lower(&file)?;
    Ok(chart::build(source, &file))
}
