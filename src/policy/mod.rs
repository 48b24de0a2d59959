//! The compiler of the policy language: from text to a [`Program`].
//!
//! The way of a policy: `grammar` (pest, `grammar/fsm.pest`) and `parse` make the syntax tree of `ast`; `lower` checks names,
//! types and units and writes the machine's code. `builtins` is the one table of what the language offers, `docs/language.md`
//! its description for users.

mod artifact;
mod ast;
mod builtins;
mod grammar;
mod hint;
mod lower;
mod parse;
mod syntax_error;
mod types;

use crate::diagnostic::{Diagnostic, Source};
use crate::machine::Program;

pub use artifact::compile_to_artifact;

/// Compiles the text of a policy.
///
/// # Errors
/// Every fault that was found, in the order of their places: one of syntax, or those of names, types, units and structure
/// (the first fifty).
///
/// ```
/// use vibrissa::{diagnostic::Source, policy::compile};
/// let source = Source::new("still.fsm", "machine still  initial Still  state Still { stop }");
/// assert_eq!(&*compile(&source)?.states[0].name, "Still");
/// # Ok::<(), Vec<vibrissa::diagnostic::Diagnostic>>(())
/// ```
pub fn compile(source: &Source) -> Result<Program, Vec<Diagnostic>> {
    let file = parse::parse(source).map_err(|diagnostic| vec![*diagnostic])?;
    lower::lower(&file)
}
