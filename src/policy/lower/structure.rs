//! The machine as a whole: names of items, states, transitions.

use std::collections::HashMap;
use std::sync::Arc;

use crate::diagnostic::{Diagnostic, suggest};
use crate::machine::{self, Block, Program};
use crate::policy::ast::{File, Guard, Name, State, Target, Transition};
use crate::policy::types::{Type, Value};
use crate::signal::MAX_WHISKERS;

use super::scope::Scope;
use super::{Compiler, StateEntry};

/// The target that ends a run in failure; no state may have its name.
const FAILURE: &str = "Failure";

/// Checks a file and writes its program. `None` when it has no state to start in.
pub(super) fn file<'f>(compiler: &mut Compiler<'f>, file: &'f File) -> Option<Program> {
    compiler.check_names(file);
    let parameters = compiler.parameters(file);
    compiler.whiskers(file);
    compiler.derived = file.derived.iter().map(|derived| (derived.name.text.as_str(), derived)).collect();
    compiler.laws = file.laws.iter().map(|law| (law.name.text.as_str(), law)).collect();
    compiler.check_derived(file);
    compiler.check_laws(file);

    // Every state's arguments need their places before any transition can lead there.
    let scopes: Vec<Option<Scope<'f>>> = file.states.iter().map(|state| compiler.declare(state)).collect();
    let mut timers = 0;
    let always = file.always.iter();
    let always = always.filter_map(|rule| compiler.transition(&Scope::default(), rule, &mut timers)).collect();
    let states = file.states.iter().zip(scopes);
    let states = states.map(|(state, scope)| compiler.state(state, scope.unwrap_or_default(), &mut timers)).collect();
    let initial = compiler.initial(file);

    if compiler.code.full {
        compiler.report(
            Diagnostic::error("P0402", "the policy grows too large", file.machine.span, "this machine")
                .hint("laws and derived values are written out wherever they are used; use them in fewer places"),
        );
    }
    Some(Program {
        name: file.machine.text.clone(),
        whiskers: file.whiskers.iter().map(|whisker| whisker.text.clone()).collect(),
        parameters,
        states,
        initial: initial?,
        always,
        code: std::mem::take(&mut compiler.code.ops),
        image: std::mem::take(&mut compiler.code.image),
        timers,
    })
}

impl<'f> Compiler<'f> {
    /// One name means one thing in the whole file.
    fn check_names(&mut self, file: &'f File) {
        let parameters = file.parameters.iter().map(|parameter| &parameter.name);
        let derived = file.derived.iter().map(|derived| &derived.name);
        let laws = file.laws.iter().map(|law| &law.name);
        let states = file.states.iter().map(|state| &state.name);
        let mut first: HashMap<&str, &Name> = HashMap::new();
        for name in file.whiskers.iter().chain(parameters).chain(derived).chain(laws).chain(states) {
            let reserved = super::super::builtins::function(&name.text).is_some()
                || ["time", FAILURE].contains(&name.text.as_str());
            if reserved {
                let message = format!("the name `{}` belongs to the language", name.text);
                self.report(
                    Diagnostic::error("P0202", message, name.span, "cannot be given").hint("choose another name"),
                );
            } else if let Some(before) = first.insert(&name.text, name) {
                let message = format!("the name `{}` is given twice", name.text);
                self.report(
                    Diagnostic::error("P0202", message, name.span, "given again here")
                        .note(before.span, "first given here"),
                );
            }
        }
    }

    fn parameters(&mut self, file: &'f File) -> Vec<machine::Parameter> {
        let mut parameters = Vec::new();
        for parameter in &file.parameters {
            if let Some(checked) = self.parameter(parameter) {
                let register = self.code.place(1);
                self.code.image[usize::from(register)] = checked.default;
                let value = Value { r#type: Type::Scalar(checked.dimension), register };
                self.globals.insert(&parameter.name.text, value);
                parameters.push(checked);
            }
        }
        parameters
    }

    fn whiskers(&mut self, file: &'f File) {
        if let Some(extra) = file.whiskers.get(MAX_WHISKERS) {
            let message = format!("a policy can bind {MAX_WHISKERS} whiskers at most");
            self.report(Diagnostic::error("P0403", message, extra.span, "one too many"));
        }
        for (index, whisker) in file.whiskers.iter().enumerate() {
            let register = self.code.constant(index as f64);
            self.globals.insert(&whisker.text, Value { r#type: Type::Whisker, register });
        }
    }

    /// Checks derived values by themselves.
    fn check_derived(&mut self, file: &'f File) {
        for derived in &file.derived {
            let before = self.diagnostics.len();
            if let Some(scope) = self.scope_of_arguments(&derived.arguments) {
                self.writing.push(&derived.name.text);
                self.expression(&scope, &derived.value);
                self.writing.pop();
            }
            self.drop_check(&derived.name, before);
        }
    }

    /// Checks laws by themselves.
    fn check_laws(&mut self, file: &'f File) {
        for law in &file.laws {
            let before = self.diagnostics.len();
            if let Some(mut scope) = self.scope_of_arguments(&law.arguments) {
                self.writing.push(&law.name.text);
                self.statements(&mut scope, &law.body);
                self.writing.pop();
            }
            self.drop_check(&law.name, before);
        }
    }

    /// Throws away the code of a check, and remembers whether it found anything.
    fn drop_check(&mut self, name: &'f Name, diagnostics_before: usize) {
        self.code.ops.clear();
        if self.diagnostics.len() > diagnostics_before {
            self.broken.push(&name.text);
        }
    }

    /// Makes a state known, with places for its arguments.
    fn declare(&mut self, state: &'f State) -> Option<Scope<'f>> {
        let index = self.states.len();
        let scope = self.scope_of_arguments(&state.arguments);
        let place = |argument: &crate::policy::ast::Argument| {
            let value = scope.as_ref()?.get(&argument.name.text)?;
            Some((argument.name.text.clone(), value))
        };
        let arguments = state.arguments.iter().filter_map(place).collect();
        self.states.insert(&state.name.text, StateEntry { index, arguments });
        scope
    }

    fn state(&mut self, state: &'f State, mut scope: Scope<'f>, timers: &mut usize) -> machine::State {
        let transitions = state.transitions.iter();
        let transitions = transitions.filter_map(|transition| self.transition(&scope, transition, timers)).collect();
        let start = self.code.here();
        self.statements(&mut scope, &state.body);
        machine::State { name: Arc::from(state.name.text.as_str()), body: self.code.since(start), transitions }
    }

    fn transition(
        &mut self,
        scope: &Scope<'f>,
        transition: &'f Transition,
        timers: &mut usize,
    ) -> Option<machine::Transition> {
        let start = self.code.here();
        let guard = match &transition.guard {
            Guard::When { condition, lasting } => {
                let truth = self.expect(scope, condition, Type::Truth);
                let lasting = match lasting {
                    None => Some(None),
                    Some(time) => self.expect(scope, time, Type::TIME).map(|time| {
                        *timers += 1;
                        Some((time.register, *timers - 1))
                    }),
                };
                let code = self.code.since(start);
                truth.zip(lasting).map(|(truth, lasting)| machine::Guard::When { code, truth: truth.register, lasting })
            }
            Guard::After(time) => {
                let time = self.expect(scope, time, Type::TIME);
                let code = self.code.since(start);
                time.map(|time| machine::Guard::After { code, time: time.register })
            }
        };
        let target = self.target(scope, &transition.target);
        Some(machine::Transition { guard: guard?, target: target? })
    }

    fn target(&mut self, scope: &Scope<'f>, target: &'f Target) -> Option<machine::Target> {
        if target.name.text == FAILURE {
            let Some(reason) = &target.text else {
                self.report(
                    Diagnostic::error("P0304", "`Failure` needs a reason", target.span, "why?")
                        .hint("write `Failure(\"what went wrong\")`"),
                );
                return None;
            };
            return Some(machine::Target::Failure(Arc::from(reason.text.as_str())));
        }
        let Some(entry) = self.states.get(target.name.text.as_str()) else {
            let message = format!("there is no state `{}`", target.name.text);
            let mut diagnostic = Diagnostic::error("P0201", message, target.name.span, "unknown state");
            let mut known: Vec<&str> = self.states.keys().copied().chain([FAILURE]).collect();
            known.sort_unstable();
            if let Some(meant) = suggest(&target.name.text, known) {
                diagnostic = diagnostic.hint(format!("did you mean `{meant}`?"));
            }
            self.report(diagnostic);
            return None;
        };
        let (state, arguments) = (entry.index, entry.arguments.clone());
        if target.text.is_some() || target.values.len() != arguments.len() {
            let names: Vec<&str> = arguments.iter().map(|(name, _)| name.as_str()).collect();
            let usage = if names.is_empty() { String::new() } else { format!("({})", names.join(", ")) };
            let message = format!("the state `{}` takes other arguments", target.name.text);
            let diagnostic = Diagnostic::error("P0304", message, target.span, "entered here");
            self.report(diagnostic.hint(format!("write `{}{usage}`", target.name.text)));
            return None;
        }
        let start = self.code.here();
        let arguments = self.pass(scope, target, &arguments, start)?;
        Some(machine::Target::State { state, arguments })
    }

    /// Writes the values that a state is entered with. All are computed before the first is put into its place: a state may
    /// hand its own arguments on to itself in another order.
    fn pass(
        &mut self,
        scope: &Scope<'f>,
        target: &'f Target,
        arguments: &[(String, Value)],
        start: u32,
    ) -> Option<Block> {
        let expected = target.values.iter().zip(arguments);
        let given: Vec<Option<Value>> =
            expected.map(|(value, (_, argument))| self.expect(scope, value, argument.r#type)).collect();
        let mut copies = Vec::with_capacity(given.len());
        for (value, (_, argument)) in given.into_iter().collect::<Option<Vec<_>>>()?.into_iter().zip(arguments) {
            let between = self.code.place(value.r#type.width());
            self.code.copy(between, value.register, value.r#type.width());
            copies.push((argument.register, between, value.r#type.width()));
        }
        for (to, from, width) in copies {
            self.code.copy(to, from, width);
        }
        Some(self.code.since(start))
    }

    fn initial(&mut self, file: &'f File) -> Option<usize> {
        let [name] = file.initial.as_slice() else {
            let diagnostic = match file.initial.as_slice() {
                [first, second, ..] => {
                    Diagnostic::error("P0404", "a machine starts in one state", second.span, "a second initial state")
                        .note(first.span, "the first")
                }
                _ => Diagnostic::error(
                    "P0404",
                    "the machine has no initial state",
                    file.machine.span,
                    "where does it start?",
                )
                .hint("write `initial` and the name of a state"),
            };
            self.report(diagnostic);
            return None;
        };
        let Some(entry) = self.states.get(name.text.as_str()) else {
            let message = format!("there is no state `{}`", name.text);
            let mut diagnostic = Diagnostic::error("P0201", message, name.span, "unknown state");
            let mut known: Vec<&str> = self.states.keys().copied().collect();
            known.sort_unstable();
            if let Some(meant) = suggest(&name.text, known) {
                diagnostic = diagnostic.hint(format!("did you mean `{meant}`?"));
            }
            self.report(diagnostic);
            return None;
        };
        if !entry.arguments.is_empty() {
            let index = entry.index;
            self.report(
                Diagnostic::error("P0404", "the initial state cannot have arguments", name.span, "starts here")
                    .hint(format!("start in a state without any that leads to state {}", file.states[index].name.text)),
            );
            return None;
        }
        Some(entry.index)
    }
}
