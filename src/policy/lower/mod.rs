//! From the syntax tree to a program: names, types, units, code.
//!
//! Laws and derived values are written into the place where they are used, so that a program has no calls. Each is checked by
//! itself first, with arguments of unknown value; one that is at fault is reported there and not again where it is used.

mod code;
mod expression;
mod function;
mod parameter;
mod scope;
mod statement;
mod structure;

use std::collections::HashMap;

use crate::diagnostic::Diagnostic;
use crate::machine::Program;

use super::ast::{Derived, File, Law};
use super::types::{Type, Value};
use code::Code;
use scope::Scope;

/// Checks a file and writes its program.
pub(super) fn lower(file: &File) -> Result<Program, Vec<Diagnostic>> {
    let mut compiler = Compiler::new();
    let program = structure::file(&mut compiler, file);
    let mut diagnostics = compiler.diagnostics;
    diagnostics.sort_by_key(|diagnostic| (diagnostic.primary.span.start, diagnostic.code));
    diagnostics.dedup();
    match program {
        Some(program) if diagnostics.is_empty() => Ok(program),
        _ => Err(diagnostics),
    }
}

/// A state that transitions can lead to.
struct StateEntry {
    index: usize,
    /// Where its arguments live.
    arguments: Vec<(String, Value)>,
}

/// Everything that is known while code is written.
struct Compiler<'f> {
    code: Code,
    diagnostics: Vec<Diagnostic>,
    /// Parameters and whiskers, by name.
    globals: HashMap<&'f str, Value>,
    derived: HashMap<&'f str, &'f Derived>,
    laws: HashMap<&'f str, &'f Law>,
    states: HashMap<&'f str, StateEntry>,
    /// Names of laws and derived values whose own check failed.
    broken: Vec<&'f str>,
    /// Names of laws and derived values that are being written into their place of use.
    writing: Vec<&'f str>,
}

impl<'f> Compiler<'f> {
    fn new() -> Self {
        Self {
            code: Code::new(),
            diagnostics: Vec::new(),
            globals: HashMap::new(),
            derived: HashMap::new(),
            laws: HashMap::new(),
            states: HashMap::new(),
            broken: Vec::new(),
            writing: Vec::new(),
        }
    }

    fn report(&mut self, diagnostic: Diagnostic) {
        self.diagnostics.push(diagnostic);
    }

    /// A scope in which `arguments` stand for values that are not known yet.
    fn scope_of_arguments(&mut self, arguments: &'f [super::ast::Argument]) -> Option<Scope<'f>> {
        let mut scope = Scope::default();
        let mut complete = true;
        for argument in arguments {
            match self.type_of(&argument.type_name) {
                Some(r#type) => {
                    let register = self.code.place(r#type.width());
                    self.bind(&mut scope, &argument.name, Value { r#type, register });
                }
                None => complete = false,
            }
        }
        complete.then_some(scope)
    }

    /// The type that a name names, if it names one.
    fn type_of(&mut self, name: &super::ast::TypeName) -> Option<Type> {
        let of = name.of.as_ref().map(|of| of.text.as_str());
        let found = Type::named(&name.base.text, of);
        if found.is_none() {
            let known = super::types::DIMENSIONS.iter().map(|&(known, _)| known);
            let wrong = name.of.as_ref().unwrap_or(&name.base);
            let mut diagnostic =
                Diagnostic::error("P0204", format!("there is no type `{}`", wrong.text), wrong.span, "unknown type");
            if let Some(meant) =
                crate::diagnostic::suggest(&wrong.text, known.clone().chain(["whisker", "truth", "vector"]))
            {
                diagnostic = diagnostic.hint(format!("did you mean `{meant}`?"));
            }
            let known = known.collect::<Vec<_>>().join(", ");
            self.report(diagnostic.hint(format!("types are whisker, truth, {known}, and `vector of` one of these")));
        }
        found
    }
}
