//! From the syntax tree to a program: names, types, units, code.
//!
//! Laws and derived values are written into the place where they are used, so that a program has no calls. Each is checked by
//! itself first, with arguments of unknown value; one that is at fault is reported there and not again where it is used.

mod code;
mod expression;
mod function;
mod hierarchy;
mod memory;
mod names;
mod parameter;
mod scope;
mod statement;
mod structure;
mod target;
mod test;

use std::collections::{HashMap, HashSet};

use crate::diagnostic::{Diagnostic, FAULT_LIMIT, Span};
use vibrissa_runtime::machine::{Program, Register};

use super::ast::{Argument, Expression, Name, Statement, TypeName};
use super::hint::did_you_mean;
use super::load::Files;
use super::test::{FigurePlace, PolicyTest};
use super::types::{DIMENSIONS, Type, Value, dimension};
use code::Code;
use hierarchy::Hierarchy;
use names::Names;
use scope::{Meaning, Scope};

pub(super) use scope::is_reserved;

/// A program, and what else is known of it once it is written.
pub(super) struct Lowered {
    pub(super) program: Program,
    pub(super) tests: Vec<PolicyTest>,
    /// What each state is entered with: names, types and places.
    pub(super) arguments: Vec<Vec<(String, Value)>>,
}

/// The types of what names stand for, by the place at which each is given its meaning.
pub(super) type Types = HashMap<Span, Type>;

/// Checks laws and derived values, those of a library by itself.
pub(super) fn check(files: &Files) -> Result<(), Vec<Diagnostic>> {
    let mut compiler = Compiler::new();
    structure::items(&mut compiler, files);
    structure::growth(&mut compiler, files.main.name.span);
    let diagnostics = in_order(compiler.diagnostics);
    if diagnostics.is_empty() { Ok(()) } else { Err(diagnostics) }
}

fn in_order(mut diagnostics: Vec<Diagnostic>) -> Vec<Diagnostic> {
    diagnostics.sort_by_key(|diagnostic| (diagnostic.primary.span.start, diagnostic.code));
    diagnostics.dedup();
    diagnostics
}

/// Checks a policy and writes its program.
pub(super) fn lower(files: &Files) -> Result<Lowered, Vec<Diagnostic>> {
    let mut compiler = Compiler::new();
    let program = structure::machine(&mut compiler, files);
    let mut states: Vec<StateEntry> = compiler.states.into_values().collect();
    states.sort_by_key(|state| state.index);
    let tests = compiler.tests;
    let diagnostics = in_order(compiler.diagnostics);
    match program {
        Some(program) if diagnostics.is_empty() => {
            let known = |(name, meaning): (String, Meaning)| meaning.map(|value| (name, value));
            let arguments = states.into_iter().map(|state| state.arguments.into_iter().filter_map(known).collect());
            Ok(Lowered { program, tests, arguments: arguments.collect() })
        }
        _ => Err(diagnostics),
    }
}

/// The types of the names in all files, as far as their faults let them be known.
pub(super) fn types(files: &Files) -> Types {
    let mut compiler = Compiler::new();
    compiler.types = Some(Types::new());
    if files.main.is_library {
        structure::items(&mut compiler, files);
    } else {
        structure::machine(&mut compiler, files);
    }
    compiler.types.unwrap_or_default()
}

/// How deep expressions, laws and derived values may nest when all of them are written out, so that walking them cannot
/// exhaust the stack.
const DEPTH_LIMIT: usize = 250;
/// The most nodes of the syntax tree that are visited, counting those of laws and derived values once for every use, so
/// that compiling takes bounded time.
const WORK_LIMIT: usize = 500_000;

/// A state that transitions can lead to.
#[derive(Clone)]
struct StateEntry {
    index: usize,
    /// Its arguments and where they live.
    arguments: Vec<(String, Meaning)>,
}

/// What gives no command, and where to put one instead.
#[derive(Clone, Copy)]
struct Commandless {
    place: &'static str,
    hint: &'static str,
}

/// Everything that is known while code is written.
struct Compiler<'f> {
    code: Code,
    diagnostics: Vec<Diagnostic>,
    /// What names stand for in each file, the policy first.
    files: Vec<Names<'f>>,
    /// The number of the file that is being written.
    here: usize,
    /// What is known of the types of names, if that is asked for.
    types: Option<Types>,
    states: HashMap<&'f str, StateEntry>,
    hierarchy: Hierarchy<'f>,
    /// Where laws and derived values are named whose own check failed.
    broken: HashSet<Span>,
    /// Laws and derived values that are being written into their place of use.
    writing: Vec<&'f Name>,
    /// What the state does whose transitions are being written.
    doing: &'f [Statement],
    /// The memory of the state whose memory is being declared.
    begun: &'f [(Name, Expression)],
    /// The memory that the machine, the state being written and its outer states have declared.
    variables: Vec<&'f Name>,
    /// Registers in which stateful functions of the state being written keep their memory: the first, and how many.
    memories: Vec<(Register, u16)>,
    /// The figures of the run that the expectation being written reads; `None` outside of tests.
    figures: Option<Vec<FigurePlace>>,
    tests: Vec<PolicyTest>,
    /// Why commands are not allowed in what is being written, if they are not.
    commandless: Option<Commandless>,
    /// Where the outermost of the laws is used that are being written.
    used: Option<Span>,
    /// How deep the walk through the syntax tree is, and how many nodes it has visited.
    depth: usize,
    work: usize,
    /// The item that was being written when the program outgrew its limits.
    outgrown: Option<Span>,
}

impl<'f> Compiler<'f> {
    fn new() -> Self {
        Self {
            code: Code::new(),
            diagnostics: Vec::new(),
            files: Vec::new(),
            here: 0,
            types: None,
            states: HashMap::new(),
            hierarchy: Hierarchy::default(),
            broken: HashSet::new(),
            writing: Vec::new(),
            doing: &[],
            begun: &[],
            variables: Vec::new(),
            memories: Vec::new(),
            figures: None,
            tests: Vec::new(),
            commandless: None,
            used: None,
            depth: 0,
            work: 0,
            outgrown: None,
        }
    }

    fn report(&mut self, diagnostic: Diagnostic) {
        if self.diagnostics.len() < FAULT_LIMIT {
            self.diagnostics.push(diagnostic);
        }
    }

    /// Whether there is no point in going on: the program is too large, or there are faults enough.
    fn is_exhausted(&self) -> bool {
        self.code.full || self.work > WORK_LIMIT || self.diagnostics.len() >= FAULT_LIMIT
    }

    /// Goes one level deeper into the syntax tree, at `span`, unless that is too deep or the compiler is exhausted.
    fn descend<T>(&mut self, span: Span, walk: impl FnOnce(&mut Self) -> Option<T>) -> Option<T> {
        self.work += 1;
        if self.is_exhausted() {
            return None;
        }
        if self.depth >= DEPTH_LIMIT {
            let message = format!("expressions, laws and derived values nest more than {DEPTH_LIMIT} deep");
            let diagnostic = Diagnostic::error("P0104", message, span, "too deep");
            self.report(
                diagnostic.hint("they are written out where they are used; let fewer of them build on one another"),
            );
            self.broken.extend(self.writing.iter().map(|name| name.span));
            return None;
        }
        self.depth += 1;
        let result = walk(self);
        self.depth -= 1;
        result
    }

    /// Takes note of the type of what `name` stands for, if it is known.
    fn note_type(&mut self, name: &Name, value: Option<Value>) {
        if let Some(types) = &mut self.types {
            types.extend(value.map(|value| (name.span, value.r#type)));
        }
    }

    /// A scope in which `arguments` stand for values that are not known yet.
    fn scope_of_arguments(&mut self, arguments: &'f [Argument]) -> Scope<'f> {
        let mut scope = Scope::default();
        self.bind_arguments(&mut scope, 0, arguments);
        scope
    }

    /// Adds `arguments`, whose values are not known yet, to a scope whose first `hidable` names they may hide.
    fn bind_arguments(&mut self, scope: &mut Scope<'f>, hidable: usize, arguments: &'f [Argument]) {
        for argument in arguments {
            let meaning = self.type_of(&argument.type_name).map(|r#type| {
                let register = self.code.place(r#type.width());
                Value { r#type, register }
            });
            self.bind(scope, hidable, &argument.name, meaning);
        }
    }

    /// The type that a name names, if it names one.
    fn type_of(&mut self, name: &TypeName) -> Option<Type> {
        let found = Type::named(name);
        if found.is_none() {
            self.report(unknown_type(name));
        }
        found
    }
}

/// The report of a type that does not exist.
fn unknown_type(name: &TypeName) -> Diagnostic {
    let dimensions = DIMENSIONS.iter().map(|&(known, _)| known);
    let list = dimensions.clone().collect::<Vec<_>>().join(", ");
    let is_dimension = |part: &Name| dimension(&part.text).is_some();
    let first = name.of.as_ref().unwrap_or(&name.base);
    match &name.of {
        Some(of) if name.base.text != "vector" => {
            let message = format!("`{}` is of nothing", name.base.text);
            Diagnostic::error("P0204", message, name.base.span.to(of.span), "only a vector is `of` a dimension")
                .hint(format!("write `{}` alone, or `vector of {}`", name.base.text, of.text))
        }
        None if name.factors.is_empty() => {
            let message = format!("there is no type `{}`", name.base.text);
            let diagnostic = Diagnostic::error("P0204", message, name.base.span, "unknown type");
            did_you_mean(diagnostic, &name.base.text, dimensions.chain(["whisker", "contour", "truth", "vector"]))
                .hint(format!("types are whisker, contour, truth, {list}, vector, and `vector of` a dimension"))
        }
        _ => match std::iter::once(first)
            .chain(name.factors.iter().map(|(_, part)| part))
            .find(|&part| !is_dimension(part))
        {
            Some(part) => {
                let message = format!("there is no dimension `{}`", part.text);
                let diagnostic = Diagnostic::error("P0204", message, part.span, "unknown dimension");
                did_you_mean(diagnostic, &part.text, dimensions).hint(format!("dimensions are {list}"))
            }
            None => Diagnostic::error("P0305", "the dimension has too large an exponent", name.span(), "of this")
                .hint("no physical quantity needs such a power"),
        },
    }
}
