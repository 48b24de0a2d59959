//! Lowering: from the syntax tree to a program. It checks names, types and units, and generates code.
//!
//! Laws and derived values are inlined, so a program has no calls. Each is first checked separately, with unknown
//! arguments. Its errors are reported there, and not again where it is used.

mod call;
mod code;
mod compound;
mod contour;
mod contract;
mod enumeration;
mod exit;
mod expression;
mod function;
mod hierarchy;
mod map;
mod memory;
mod monitor;
mod names;
mod needs;
mod operator;
mod output;
mod parameter;
mod property;
mod scope;
mod signal;
mod statement;
mod structure;
mod target;
mod test;

use std::collections::{BTreeMap, HashMap, HashSet};
use std::rc::Rc;
use std::sync::Arc;

use vibrissa_runtime::machine::{Program, Register};
use vibrissa_text::diagnostic::{Diagnostic, FAULT_LIMIT, Span};

use super::analysis::ProvedContract;
use super::ast::{Argument, Enumeration, Expression, Monitor, Name, Statement, TypeName};
use super::load::Files;
use super::suggestion::did_you_mean;
use super::test::{FigureRegister, PolicyTest};
use super::types::{DIMENSIONS, PLAIN_TYPES, Type, Value, dimension};
use code::Code;
use compound::Layout;
use hierarchy::Hierarchy;
use memory::Variables;
use monitor::Running;
use names::Names;
use scope::{Meaning, Scope, in_the_standard_library};

pub(super) use code::{Origin, Origins};
pub(super) use scope::is_reserved;
pub(super) use structure::SUCCESS;

/// A program, and the further results of lowering.
pub(super) struct Lowered {
    pub(super) program: Program,
    pub(super) tests: Vec<PolicyTest>,
    /// The arguments of each state: names, types and registers.
    pub(super) arguments: Vec<Vec<(String, Value)>>,
    /// The names of the values of each enumeration, by the span of its name.
    pub(super) choices: HashMap<Span, Vec<String>>,
    /// The memory of the machine, and for each state its arguments and memory.
    pub(super) memory: Memory,
    /// The expressions whose values are in the registers.
    pub(super) origins: Origins,
    /// For every message, the spans of its values.
    pub(super) logged: Vec<Vec<Span>>,
    /// The contracts that the analysis has proved. Empty before it.
    pub(super) proved: Vec<ProvedContract>,
}

/// The values that a running machine keeps from tick to tick: names, types and registers.
#[derive(Debug, Default)]
pub(super) struct Memory {
    pub(super) machine: Vec<(String, Value)>,
    pub(super) states: Vec<Vec<(String, Value)>>,
}

/// The types of names, by the span of their declaration.
pub(super) type Types = HashMap<Span, Type>;

/// Checks laws and derived values, those of a library separately.
pub(super) fn check(files: &Files) -> Result<(), Vec<Diagnostic>> {
    let mut compiler = Compiler::new();
    structure::items(&mut compiler, files);
    structure::report_size(&mut compiler, files.main.name.span);
    let diagnostics = in_order(compiler.diagnostics);
    if diagnostics.is_empty() { Ok(()) } else { Err(diagnostics) }
}

fn in_order(mut diagnostics: Vec<Diagnostic>) -> Vec<Diagnostic> {
    diagnostics.sort_by_key(|diagnostic| (diagnostic.primary.span.start, diagnostic.code));
    diagnostics.dedup();
    diagnostics
}

/// Checks a policy and generates its program.
pub(super) fn lower(files: &Files) -> Result<Lowered, Vec<Diagnostic>> {
    let mut compiler = Compiler::new();
    let program = structure::machine(&mut compiler, files);
    let choices = compiler.choices();
    let mut states: Vec<StateEntry> = std::mem::take(&mut compiler.states).into_values().collect();
    states.sort_by_key(|state| state.index);
    let (tests, diagnostics) =
        (std::mem::take(&mut compiler.tests), in_order(std::mem::take(&mut compiler.diagnostics)));
    match program {
        Some(program) if diagnostics.is_empty() => {
            // A monitor that is an argument has no register.
            let has_register = |value: &Value| !matches!(value.r#type, Type::Monitor(_));
            let known = |(name, meaning): (String, Meaning)| Some((name, meaning.filter(has_register)?));
            let arguments = states.into_iter().map(|state| state.arguments.into_iter().filter_map(known).collect());
            let arguments = arguments.map(|values| compiler.parts(values)).collect();
            let (memory, origins, logged) = (compiler.memory, compiler.code.origins, compiler.code.logged);
            Ok(Lowered { program, tests, arguments, choices, memory, origins, logged, proved: Vec::new() })
        }
        _ => Err(diagnostics),
    }
}

/// The types of the names in all files, as far as errors permit.
pub(super) fn types(files: &Files) -> Types {
    let mut compiler = Compiler::new();
    compiler.types = Some(Types::new());
    if files.main.is_library() {
        structure::items(&mut compiler, files);
    } else {
        structure::machine(&mut compiler, files);
    }
    compiler.types.unwrap_or_default()
}

/// The maximum nesting depth of expressions after inlining, so that recursion cannot exhaust the stack.
const DEPTH_LIMIT: usize = 250;
/// The maximum number of visited nodes of the syntax tree, with inlined ones counted for every use. It bounds the time
/// of compilation.
const WORK_LIMIT: usize = 500_000;

/// The code of an error that depends on where a law is used, so that other uses of the law may be valid.
const WRONG_PLACE: &str = "P0407";

/// A state as the target of transitions.
#[derive(Clone)]
struct StateEntry {
    index: usize,
    /// Its arguments and their registers.
    arguments: Vec<(String, Meaning)>,
}

/// A construct that gives no command, with advice where to put the command.
#[derive(Clone, Copy)]
struct Commandless {
    construct: &'static str,
    hint: &'static str,
    /// True if `record` and `mark` are allowed.
    allows_records: bool,
}

/// The state of the compiler during lowering.
struct Compiler<'f> {
    code: Code,
    diagnostics: Vec<Diagnostic>,
    /// Number of errors, also repeated ones, that do not depend on where a law or a derived value is used.
    faults: usize,
    /// The names of each file, the policy first.
    files: Vec<Names<'f>>,
    /// The enumerations of all files, by the span of their names.
    enumerations: HashMap<Span, &'f Enumeration>,
    /// The numbers of the values of all enumerations, by the span of their names.
    choice_numbers: HashMap<Span, HashMap<&'f str, usize>>,
    /// The monitors of all files that others can use, by the span of their names, each with the number of its file.
    monitors: HashMap<Span, (usize, &'f Monitor)>,
    /// The registers of the records and lists of all files, by the span of their names. `None` for a type with an error, which has been
    /// reported.
    layouts: HashMap<Span, Option<Layout<'f>>>,
    /// The number of the current file.
    current_file: usize,
    /// The types of names, if they are requested.
    types: Option<Types>,
    /// The states of each instance by their names.
    states: HashMap<(usize, &'f str), StateEntry>,
    hierarchy: Hierarchy<'f>,
    /// For each state, the names that it knows.
    scopes: Vec<Rc<Scope<'f>>>,
    memory: Memory,
    /// Declarations of laws and derived values with errors.
    erroneous: HashSet<Span>,
    /// Laws and derived values that are being inlined.
    inlining: Vec<&'f Name>,
    /// The statements of the state whose transitions are being lowered.
    state_body: &'f [Statement],
    /// The memory of the state whose memory is being declared.
    declaring: &'f [(Name, Expression)],
    /// The memory of the machine, of the current state and of its outer states.
    variables: Variables<'f>,
    /// The monitors of the machine, or unknown ones of a part that is checked alone.
    running: Vec<Running<'f>>,
    /// The names of the machine: its memory and its monitors.
    own_names: Rc<Scope<'f>>,
    /// The first registers of the memory of monitors, and the number of registers.
    monitor_registers: BTreeMap<Register, u16>,
    /// Monitors that take themselves as arguments, directly or through others, and those that take such a monitor.
    endless: HashSet<Span>,
    /// Memory of stateful functions in the current state: the first register, and the number of registers.
    memories: Vec<(Register, u16)>,
    /// The figures that the current expectation reads. `None` outside of tests.
    figures: Option<Vec<FigureRegister>>,
    tests: Vec<PolicyTest>,
    /// The indices of the states by their names in the whole machine, if a test has asked for one.
    paths: Option<HashMap<String, usize>>,
    /// The initial registers of the program, without those of a test.
    tested: Option<Arc<[f64]>>,
    /// The construct that does not allow commands here, if there is one.
    commandless: Option<Commandless>,
    /// Span of the use of the outermost law that is being inlined.
    outer_use: Option<Span>,
    /// The register of the time at which the current state was entered. `None` outside of states.
    entered: Option<Register>,
    /// Index of the state whose code is being generated. `None` outside of states.
    current_state: Option<usize>,
    /// Number of contracts.
    contract_count: usize,
    /// Current depth in the syntax tree, and number of visited nodes.
    depth: usize,
    work: usize,
    /// True while an item is lowered whose errors are reported where it is declared.
    is_told_elsewhere: bool,
    /// The item that was being lowered when the program exceeded its limits.
    oversized_item: Option<Span>,
}

impl<'f> Compiler<'f> {
    fn new() -> Self {
        Self {
            code: Code::new(),
            diagnostics: Vec::new(),
            faults: 0,
            files: Vec::new(),
            enumerations: HashMap::new(),
            choice_numbers: HashMap::new(),
            monitors: HashMap::new(),
            layouts: HashMap::new(),
            current_file: 0,
            types: None,
            states: HashMap::new(),
            hierarchy: Hierarchy::default(),
            scopes: Vec::new(),
            memory: Memory::default(),
            erroneous: HashSet::new(),
            inlining: Vec::new(),
            state_body: &[],
            declaring: &[],
            variables: Variables::default(),
            running: Vec::new(),
            own_names: Rc::default(),
            monitor_registers: BTreeMap::new(),
            endless: HashSet::new(),
            memories: Vec::new(),
            figures: None,
            tests: Vec::new(),
            paths: None,
            tested: None,
            commandless: None,
            outer_use: None,
            entered: None,
            current_state: None,
            contract_count: 0,
            depth: 0,
            work: 0,
            is_told_elsewhere: false,
            oversized_item: None,
        }
    }

    fn report(&mut self, diagnostic: Diagnostic) {
        self.faults += usize::from(diagnostic.code != WRONG_PLACE);
        // Copies of a behaviour have the same errors.
        if self.diagnostics.len() < FAULT_LIMIT && !self.diagnostics.contains(&diagnostic) {
            self.diagnostics.push(diagnostic);
        }
    }

    /// True if an error need not be reported, because there are enough, or one with the same code at the same place. To look for a
    /// similar name takes time, and copies of a behaviour have the same errors. It counts as reported.
    fn is_told(&mut self, code: &'static str, span: Span) -> bool {
        let is_same = |known: &Diagnostic| known.code == code && known.primary.span == span;
        let is_told =
            self.is_told_elsewhere || self.diagnostics.len() >= FAULT_LIMIT || self.diagnostics.iter().any(is_same);
        self.faults += usize::from(is_told);
        is_told
    }

    /// True if lowering should stop: the program is too large, or there are enough errors.
    fn is_exhausted(&self) -> bool {
        self.code.full || self.work > WORK_LIMIT || self.diagnostics.len() >= FAULT_LIMIT
    }

    /// Enters one level of the syntax tree at `span`, unless that is too deep or the compiler is exhausted.
    fn descend<T>(&mut self, span: Span, walk: impl FnOnce(&mut Self) -> Option<T>) -> Option<T> {
        self.work += 1;
        if self.is_exhausted() {
            return None;
        }
        if self.depth >= DEPTH_LIMIT {
            let message = format!("expressions, laws and derived values are nested more than {DEPTH_LIMIT} deep");
            let diagnostic = Diagnostic::error("P0104", message, span, "too deep");
            self.report(diagnostic.hint("laws and derived values are inlined at every use; reduce their nesting"));
            self.erroneous.extend(self.inlining.iter().map(|name| name.span));
            return None;
        }
        self.depth += 1;
        let result = walk(self);
        self.depth -= 1;
        result
    }

    /// Records the type of `name`, if it is known.
    fn note_type(&mut self, name: &Name, value: Option<Value>) {
        if let Some(types) = &mut self.types {
            types.extend(value.map(|value| (name.span, value.r#type)));
        }
    }

    /// A scope in which `arguments` have unknown values.
    fn scope_of_arguments(&mut self, arguments: &'f [Argument]) -> Scope<'f> {
        let mut scope = Scope::default();
        self.bind_arguments(&mut scope, 0, arguments);
        scope
    }

    /// Adds `arguments` with unknown values to a scope. They may hide its first `hidable` names.
    fn bind_arguments(&mut self, scope: &mut Scope<'f>, hidable: usize, arguments: &'f [Argument]) {
        for argument in arguments {
            let meaning = self.type_of(&argument.type_name).and_then(|r#type| match r#type {
                Type::Monitor(content) => self.unknown_monitor(content),
                _ => Some(Value { r#type, register: self.code.allocate(r#type.width()) }),
            });
            self.bind(scope, hidable, &argument.name, meaning);
        }
    }

    /// The type with a name, if there is one.
    fn type_of(&mut self, name: &TypeName) -> Option<Type> {
        let found = self.named_type(name);
        if found.is_none() && !self.has_no_layout(name) && !self.is_told("P0204", name.base.span) {
            let names = self.names();
            let own = names.enumerations.keys().chain(names.compounds.keys()).chain(names.monitors.keys());
            let own: Vec<&str> = own.copied().collect();
            let diagnostic = unknown_type(name, &own);
            self.report(diagnostic);
        }
        found
    }
}

/// The diagnostic for an unknown type. `own` are the types of the file.
fn unknown_type(name: &TypeName, own: &[&str]) -> Diagnostic {
    let dimensions = DIMENSIONS.iter().map(|&(known, _)| known);
    let list = dimensions.clone().collect::<Vec<_>>().join(", ");
    let is_dimension = |part: &Name| dimension(&part.text).is_some();
    let first = name.of.as_ref().unwrap_or(&name.base);
    match &name.of {
        Some(of) if name.base.text != "vector" => {
            let message = format!("the type `{}` takes no dimension", name.base.text);
            Diagnostic::error("P0204", message, name.base.span.to(of.span), "only a vector is `of` a dimension")
                .hint(format!("write `{}` alone, or `vector of {}`", name.base.text, of.text))
        }
        None if name.factors.is_empty() => {
            let message = format!("there is no type `{}`", name.base.text);
            let diagnostic = Diagnostic::error("P0204", message, name.base.span, "unknown type");
            let known = dimensions.chain(PLAIN_TYPES).chain(own.iter().copied());
            in_the_standard_library(did_you_mean(diagnostic, &name.base.text, known), &name.base.text)
                .hint(format!("types are {}, `vector of` a dimension, {list}", PLAIN_TYPES.join(", ")))
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
                .hint("use exponents that physical quantities have"),
        },
    }
}
