//! The compiler of the policy language: from text to a [`Program`].
//!
//! The way of a policy: `grammar` (pest, `grammar/fsm.pest`) finds what stands in a text, which `pair` lays out flat and `parse` makes
//! the syntax tree of `ast` of; `recover` has as much of it as can be had of a text with faults; `lower` checks names, types and units
//! and writes the machine's code; `optimise` shortens that; `analysis` looks at both for what is probably not meant; `format` lays
//! texts out. `description` reads what comments say of items. `builtins` is the one table of what the language offers, `docs/language.md`
//! its description for users.

mod analysis;
mod artifact;
mod ast;
mod builtins;
pub mod chart;
mod description;
mod foreign;
mod format;
mod grammar;
mod hint;
pub mod index;
mod load;
mod lower;
mod optimise;
mod pair;
mod parse;
mod path;
mod recover;
mod standard;
mod syntax_error;
mod test;
mod types;
mod unit;

pub use format::format;
pub use load::Library;
pub use test::{Expectation, PolicyTest, RunFigure};

use crate::diagnostic::{Diagnostic, Source, Span};
use load::{Files, Loaded};
use vibrissa_runtime::machine::{Artifact, Program};

/// A policy that compiled.
#[derive(Debug, Clone, PartialEq)]
pub struct Compiled {
    /// The program, and where it comes from.
    pub artifact: Artifact,
    /// The tests that it carries, in the order of the text.
    pub tests: Vec<PolicyTest>,
    /// What is probably not meant, in the order of the text (the first fifty).
    pub warnings: Vec<Diagnostic>,
}

/// What a file holds that has no fault.
#[derive(Debug, Clone, PartialEq)]
pub enum Checked {
    /// A machine.
    Machine(Box<Compiled>),
    /// A library.
    Library {
        /// Its name.
        name: String,
        /// Names of its laws.
        laws: Vec<String>,
        /// Names of its derived values.
        values: Vec<String>,
        /// What is probably not meant.
        warnings: Vec<Diagnostic>,
    },
}

/// Adds to a source, as parts, all files that it uses: those of the standard library, and those that `library` gives. Whatever
/// is said of the source then can show places in these files too.
///
/// Faults are told when the source is compiled, also why a file could not be had.
///
/// ```
/// use vibrissa::{diagnostic::Source, policy::{compile, gather}};
/// let source = Source::new("a/still.fsm", "machine still  use \"laws/rest.fsm\"  initial Still  state Still { do rest() }");
/// let source = gather(&source, &mut |path: &str| match path {
///     "a/laws/rest.fsm" => Ok("library rest  law rest() { stop }".to_owned()),
///     other => Err(format!("there is no {other}")),
/// });
/// assert_eq!(source.part_name(1), "a/laws/rest.fsm");
/// assert!(compile(&source).is_ok());
/// ```
#[must_use]
pub fn gather(source: &Source, library: &mut Library<'_>) -> Source {
    load::load(source, library).source
}

/// Compiles the text of a policy. Of the files that it uses only the standard library and parts of the source are known.
///
/// # Errors
/// Every fault that was found, in the order of their places: those of syntax, of the files' uses, of names, types, units and
/// structure (the first fifty), or cycles of transitions that a tick cannot end.
///
/// ```
/// use vibrissa::{diagnostic::Source, policy::compile};
/// let source = Source::new("still.fsm", "machine still  initial Still  state Still { stop }");
/// assert_eq!(&*compile(&source)?.states[0].name, "Still");
/// # Ok::<(), Vec<vibrissa::diagnostic::Diagnostic>>(())
/// ```
pub fn compile(source: &Source) -> Result<Program, Vec<Diagnostic>> {
    Ok(optimise::optimise(front(source, load(source))?.2.program))
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
    compile_loaded(source, load(source))
}

/// The source that [`gather`] makes, and what [`compile_with_warnings`] makes of that; every text is read once.
pub fn gather_and_compile(source: &Source, library: &mut Library<'_>) -> (Source, Result<Compiled, Vec<Diagnostic>>) {
    let loaded = load::load(source, library);
    let whole = loaded.source.clone();
    let compiled = compile_loaded(&whole, loaded);
    (whole, compiled)
}

fn compile_loaded(source: &Source, loaded: Loaded) -> Result<Compiled, Vec<Diagnostic>> {
    let (source, files, lowered) = front(source, loaded)?;
    let warnings = analysis::warnings(&files, &lowered);
    // Behind the analysis, which takes conditions as they are written.
    let program = optimise::optimise(lowered.program);
    let artifact = artifact::artifact(&source, &files.main, program);
    Ok(Compiled { artifact, tests: lowered.tests, warnings })
}

/// Checks a policy or a library.
///
/// # Errors
/// As [`compile`].
pub fn check(source: &Source) -> Result<Checked, Vec<Diagnostic>> {
    let loaded = load(source);
    if !loaded.is_library() {
        return compile_loaded(source, loaded).map(|compiled| Checked::Machine(Box::new(compiled)));
    }
    let (whole, files, recovery) = loaded.files();
    let Some(files) = files else { return Err(within(source, &whole, recovery.join(&whole, Vec::new()))) };
    let faults = recovery.join(&whole, lower::check(&files).err().unwrap_or_default());
    if !faults.is_empty() {
        return Err(within(source, &whole, faults));
    }
    let names = |names: &mut dyn Iterator<Item = &ast::Name>| names.map(|name| name.text.clone()).collect();
    Ok(Checked::Library {
        name: files.main.name.text.clone(),
        laws: names(&mut files.main.laws.iter().map(|law| &law.name)),
        values: names(&mut files.main.derived.iter().map(|derived| &derived.name)),
        warnings: analysis::library_warnings(&files),
    })
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
    let (source, files, _) = lowered(source, load(source))?;
    Ok(chart::build(&source, &files.main))
}

fn front(source: &Source, loaded: Loaded) -> Result<(Source, Files, lower::Lowered), Vec<Diagnostic>> {
    let (whole, files, lowered) = lowered(source, loaded)?;
    let errors = analysis::errors(&files.main, &lowered);
    if errors.is_empty() { Ok((whole, files, lowered)) } else { Err(errors) }
}

fn lowered(source: &Source, loaded: Loaded) -> Result<(Source, Files, lower::Lowered), Vec<Diagnostic>> {
    let (whole, files, recovery) = loaded.files();
    let mut faults = Vec::new();
    if let Some(files) = files {
        let lowered = if files.main.is_library { Err(vec![library(&files.main)]) } else { lower::lower(&files) };
        match lowered {
            Ok(mut lowered) if recovery.is_whole() => {
                description::describe(&mut lowered.program, &whole, &files.main);
                return Ok((whole, files, lowered));
            }
            Ok(_) => {}
            Err(found) => faults = found,
        }
    }
    Err(within(source, &whole, recovery.join(&whole, faults)))
}

/// The report of a library where a machine is needed.
fn library(file: &ast::File) -> Diagnostic {
    let message = format!("`{}` is a library and does nothing by itself", file.name.text);
    let fault = Diagnostic::error("P0603", message, file.name.span, "not a machine");
    fault.hint("give a policy, which begins with `machine` and uses this file; `check` takes both")
}

/// A source with all that it uses, as far as that is in it or in the standard library.
fn load(source: &Source) -> Loaded {
    load::load(source, &mut |_: &str| Err("there is no such file among those given".to_owned()))
}

/// Faults as they can be shown in `source`, which may lack parts that `whole` has.
fn within(source: &Source, whole: &Source, faults: Vec<Diagnostic>) -> Vec<Diagnostic> {
    let is_in = |span: Span| span.start <= source.text.len();
    let shown = faults.into_iter().map(|mut fault| {
        if !is_in(fault.primary.span) {
            let part = whole.part_name(whole.part_at(fault.primary.span.start));
            fault.primary.text = format!("{}, in `{part}`", fault.primary.text);
            fault.primary.span = Span::new(0, 0);
        }
        fault.secondary.retain(|label| is_in(label.span));
        fault
    });
    shown.collect()
}
