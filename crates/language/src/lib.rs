//! The compiler of the policy language: from text to a [`Program`].
//!
//! - `grammar` parses a text with pest (`grammar/fsm.pest`). `word` has the words of the language, from which all lists of
//!   words follow.
//! - `parse_tree` stores the result in a flat list with all tokens. `token` reads them with comments, blanks and line ends.
//! - `parse` builds the syntax tree of `ast`. `recover` continues after syntax errors. `scan` finds where to.
//! - `expand` copies behaviours into the states that use them.
//! - `lower` checks names, types and units, and generates code.
//! - `analysis` finds probable mistakes in the tree and the code.
//! - `optimise` shortens the code.
//! - `explain` relates the guards of a running program to their texts.
//! - `format` formats texts. `description` reads comments of items. `index` answers questions of editors.
//! - `server` is the language server.
//! - `builtins` has the tables of members and functions. `docs/language.md` introduces the language to users.
//!
//! # Where to begin
//!
//! A text of an editor is in the table of words, a message next to its error in `lower` or `analysis`, a function of policies in
//! `builtins/function.rs` and `lower/function.rs`. A new warning is a file of `analysis`. Read `docs/decisions/compiler.md` before you change `lower` or `optimise`,
//! because the bits of all results and the bounds of a tick depend on them. `tests/policy` has a second, independent interpreter.

// The code that pest writes for a grammar without `std` names it.
extern crate alloc;

mod analysis;
mod artifact;
mod ast;
mod builtins;
pub mod chart;
mod defaults;
mod description;
mod expand;
pub mod explain;
mod foreign_syntax;
mod format;
mod grammar;
pub mod index;
mod load;
mod lower;
mod optimise;
mod parse;
mod parse_tree;
mod path;
mod recover;
mod scan;
mod scopes;
#[cfg(feature = "server")]
pub mod server;
mod standard;
mod suggestion;
mod syntax_error;
mod test;
mod token;
mod types;
mod unit;
mod word;
#[cfg(test)]
mod word_reference;
mod words;

pub use analysis::ProvedContract;
pub use defaults::with_defaults;
pub use format::format;
pub use load::Library;
pub use scopes::scopes;
pub use standard::{Module, install};
pub use test::{Expectation, ParameterRange, PlotFigure, PolicyTest, RunFigure, TestScenes};

use load::{Files, Loaded};
use vibrissa_runtime::machine::{Artifact, Program};
use vibrissa_text::diagnostic::{Diagnostic, Source, Span};

/// A policy that compiled.
#[derive(Debug, Clone, PartialEq)]
pub struct Compiled {
    /// The program with its source.
    pub artifact: Artifact,
    /// The tests of the policy, in the order of the text.
    pub tests: Vec<PolicyTest>,
    /// True if the text is a test file. Then the program is that of the tested machine.
    pub is_test_file: bool,
    /// Warnings about probable mistakes, in the order of the text (the first fifty). A test file has none.
    pub warnings: Vec<Diagnostic>,
    /// The contracts that no run can violate. The program does not contain them.
    pub proved: Vec<ProvedContract>,
}

/// The content of a file without errors.
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
        /// Names of its monitors.
        monitors: Vec<String>,
        /// Names of its behaviours.
        behaviours: Vec<String>,
        /// Warnings about probable mistakes.
        warnings: Vec<Diagnostic>,
    },
}

/// Adds all used files to a source as parts. They come from the standard library and from `library`.
///
/// Diagnostics of the resulting source can have positions in these files. Errors, including files that could not be
/// read, are reported by [`compile`].
///
/// ```
/// use vibrissa_text::diagnostic::Source;
/// use vibrissa_language::{compile, gather};
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

/// Adds the modules of the standard library that a text uses, like [`gather`] but without parsing, which takes most of the time of a
/// compilation. It sees only uses at the start of a line. A caller compares the hash of the resulting text with a known one.
#[must_use]
pub fn gather_modules(source: &Source) -> Source {
    load::modules(source)
}

/// Compiles the text of a policy. It may use the standard library and the parts of the source.
///
/// # Errors
/// All errors, in the order of their positions: of syntax, imports, names, types, units and structure (the first
/// fifty). If there are none, cycles of transitions that exceed the microstep limit of a tick.
///
/// ```
/// use vibrissa_text::diagnostic::Source;
/// use vibrissa_language::compile;
/// let source = Source::new("still.fsm", "machine still  initial Still  state Still { stop }");
/// assert_eq!(&*compile(&source)?.states[0].name, "Still");
/// # Ok::<(), Vec<vibrissa_text::diagnostic::Diagnostic>>(())
/// ```
pub fn compile(source: &Source) -> Result<Program, Vec<Diagnostic>> {
    Ok(optimise::optimise(front(source, load(source), Analysis::Whole)?.2.program))
}

/// Compiles the text of a policy, and looks for probable mistakes.
///
/// # Errors
/// Those of [`compile`].
///
/// ```
/// use vibrissa_text::diagnostic::Source;
/// use vibrissa_language::compile_with_warnings;
/// let source = Source::new("still.fsm", "machine still  initial Still  state Still { stop }");
/// assert_eq!(compile_with_warnings(&source)?.warnings[0].message, "the state `Still` cannot be left");
/// # Ok::<(), Vec<vibrissa_text::diagnostic::Diagnostic>>(())
/// ```
pub fn compile_with_warnings(source: &Source) -> Result<Compiled, Vec<Diagnostic>> {
    compile_loaded(source, load(source), Analysis::Whole)
}

/// Whether a text is searched for mistakes in its behaviour, which takes most of the time of a compilation.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Analysis {
    /// All warnings, and cycles of transitions.
    Whole,
    /// Neither, for a text that is known to have none.
    Omitted,
}

/// Combines [`gather`] and [`compile_with_warnings`], and parses every text once.
pub fn gather_and_compile(
    source: &Source,
    library: &mut Library<'_>,
    analysis: Analysis,
) -> (Source, Result<Compiled, Vec<Diagnostic>>) {
    let loaded = load::load(source, library);
    let whole = loaded.source.clone();
    let compiled = compile_loaded(&whole, loaded, analysis);
    (whole, compiled)
}

fn compile_loaded(source: &Source, loaded: Loaded, analysis: Analysis) -> Result<Compiled, Vec<Diagnostic>> {
    let is_test_file = loaded.is_test_file();
    let (source, files, lowered) = front(source, loaded, analysis)?;
    // The warnings belong to the machine's own file.
    let is_silent = is_test_file || analysis == Analysis::Omitted;
    let warnings = if is_silent { Vec::new() } else { analysis::warnings(&files, &lowered) };
    // After the analysis, which reads conditions as they are written.
    let program = optimise::optimise(lowered.program);
    let artifact = artifact::artifact(&source, &files, program);
    Ok(Compiled { artifact, tests: lowered.tests, is_test_file, warnings, proved: lowered.proved })
}

/// Checks a policy or a library.
///
/// # Errors
/// Those of [`compile`].
pub fn check(source: &Source) -> Result<Checked, Vec<Diagnostic>> {
    let loaded = load(source);
    if !loaded.is_library() {
        return compile_loaded(source, loaded, Analysis::Whole).map(|compiled| Checked::Machine(Box::new(compiled)));
    }
    let (_, files) = checked_library(source, loaded)?;
    let names = |names: &mut dyn Iterator<Item = &ast::Name>| names.map(|name| name.text.clone()).collect();
    Ok(Checked::Library {
        name: files.main.name.text.clone(),
        laws: names(&mut files.main.laws.iter().map(|law| &law.name)),
        values: names(&mut files.main.derived.iter().map(|derived| &derived.name)),
        monitors: names(&mut files.main.monitors.iter().map(|monitor| &monitor.name)),
        behaviours: names(&mut files.main.behaviours.iter().map(|behaviour| &behaviour.name)),
        warnings: analysis::library_warnings(&files),
    })
}

/// The statechart of a policy, or those of the behaviours of a library.
///
/// # Errors
/// Those of [`compile`]. A policy with errors has no chart.
///
/// ```
/// use vibrissa_text::diagnostic::Source;
/// use vibrissa_language::chart;
/// let source = Source::new("still.fsm", "machine still  initial Still  state Still { after 1 s -> Failure(\"late\") }");
/// assert_eq!(chart(&source)?.transitions[0].guard, chart::Guard::After("1 s".to_owned()));
/// # Ok::<(), Vec<vibrissa_text::diagnostic::Diagnostic>>(())
/// ```
pub fn chart(source: &Source) -> Result<chart::Chart, Vec<Diagnostic>> {
    let loaded = load(source);
    if !loaded.is_library() {
        let (source, files, _) = lowered(source, loaded)?;
        return Ok(chart::build(&source, &files));
    }
    let (whole, files) = checked_library(source, loaded)?;
    if files.main.behaviours.is_empty() {
        return Err(vec![library(&files.main)]);
    }
    Ok(chart::build(&whole, &files))
}

/// The files of a library without errors, with all texts.
fn checked_library(source: &Source, loaded: Loaded) -> Result<(Source, Files), Vec<Diagnostic>> {
    let (whole, files, recovery) = loaded.files();
    let Some(files) = files else { return Err(within(source, &whole, recovery.join(&whole, Vec::new()))) };
    let faults = recovery.join(&whole, lower::check(&files).err().unwrap_or_default());
    if faults.is_empty() { Ok((whole, files)) } else { Err(within(source, &whole, faults)) }
}

fn front(
    source: &Source,
    loaded: Loaded,
    analysis: Analysis,
) -> Result<(Source, Files, lower::Lowered), Vec<Diagnostic>> {
    let (whole, mut files, mut lowered) = lowered(source, loaded)?;
    let errors = match analysis {
        Analysis::Whole => analysis::errors(&files, &lowered),
        Analysis::Omitted => Vec::new(),
    };
    if !errors.is_empty() {
        return Err(errors);
    }
    lowered.proved = analysis::take_proved(&mut files, &mut lowered);
    Ok((whole, files, lowered))
}

fn lowered(source: &Source, loaded: Loaded) -> Result<(Source, Files, lower::Lowered), Vec<Diagnostic>> {
    let (whole, files, recovery) = loaded.files();
    let mut faults = Vec::new();
    if let Some(files) = files {
        let lowered = if files.main.is_library() { Err(vec![library(&files.main)]) } else { lower::lower(&files) };
        match lowered {
            Ok(mut lowered) if recovery.is_whole() => {
                description::describe(&mut lowered, &whole, &files);
                return Ok((whole, files, lowered));
            }
            Ok(_) => {}
            Err(found) => faults = found,
        }
    }
    Err(within(source, &whole, recovery.join(&whole, faults)))
}

/// The diagnostic for a library where a machine is needed.
fn library(file: &ast::File) -> Diagnostic {
    let message = format!("`{}` is a library and cannot run by itself", file.name.text);
    let fault = Diagnostic::error("P0603", message, file.name.span, "not a machine");
    fault.hint("give a policy, which begins with `machine` and uses this file; `check` takes both")
}

/// Loads a source with its used files, as far as they are parts of it or in the standard library.
fn load(source: &Source) -> Loaded {
    load::load(source, &mut |_: &str| Err("there is no such file among those given".to_owned()))
}

/// Restricts diagnostics to `source`, which may lack parts of `whole`.
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
