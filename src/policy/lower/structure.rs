//! The machine as a whole: names of items, states, transitions.

use std::sync::Arc;

use crate::diagnostic::{Diagnostic, Span};
use crate::machine::{self, Block, Op, Program};
use crate::policy::ast::{Argument, File, Guard, Name, State, Target, Transition};
use crate::policy::hint::did_you_mean;
use crate::policy::types::{Type, Value};
use crate::signal::MAX_WHISKERS;

use super::function::count;
use super::scope::{Meaning, Scope, is_reserved, reserved, taken};
use super::{Compiler, StateEntry};

/// The target that ends a run in failure; no state may have its name.
pub(super) const FAILURE: &str = "Failure";

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
    let scopes: Vec<Scope<'f>> = file.states.iter().map(|state| compiler.declare(state)).collect();
    let mut timers = 0;
    let always = file.always.iter();
    let always = always.filter_map(|rule| compiler.transition(&Scope::default(), rule, &mut timers)).collect();
    let states = file.states.iter().zip(scopes);
    let states = states.map(|(state, scope)| compiler.state(state, scope, &mut timers)).collect();
    let initial = compiler.initial(file);

    compiler.watch_growth(file.machine.span);
    if let Some(item) = compiler.outgrown {
        compiler.report(
            Diagnostic::error("P0402", "the policy grows too large", item, "grows out of bounds here")
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
        for name in file.whiskers.iter().chain(parameters).chain(derived).chain(laws).chain(states) {
            if is_reserved(&name.text) {
                self.report(reserved(name));
            } else if let Some(&before) = self.items.get(name.text.as_str()) {
                self.report(taken(name, before));
            } else {
                self.items.insert(&name.text, name.span);
            }
        }
    }

    fn parameters(&mut self, file: &'f File) -> Vec<machine::Parameter> {
        let mut parameters = Vec::new();
        for parameter in &file.parameters {
            let meaning = self.parameter(parameter).map(|checked| {
                let register = self.code.place(1);
                self.code.image[usize::from(register)] = checked.default;
                let r#type = Type::Scalar(checked.dimension);
                parameters.push(checked);
                Value { r#type, register }
            });
            self.globals.insert(&parameter.name.text, meaning);
        }
        parameters
    }

    fn whiskers(&mut self, file: &'f File) {
        if let Some(extra) = file.whiskers.get(MAX_WHISKERS) {
            let message = format!("a policy can bind {MAX_WHISKERS} whiskers at most");
            let diagnostic = Diagnostic::error("P0403", message, extra.span, "one too many");
            self.report(diagnostic.hint("bind those that the policy reads; the rig may have others"));
        }
        for (index, whisker) in file.whiskers.iter().enumerate() {
            let register = self.code.constant(index as f64);
            self.globals.insert(&whisker.text, Some(Value { r#type: Type::Whisker, register }));
        }
    }

    /// Checks derived values by themselves.
    fn check_derived(&mut self, file: &'f File) {
        for derived in &file.derived {
            self.check(&derived.name, &derived.arguments, |compiler, scope| {
                let value = compiler.expression(scope, &derived.value);
                compiler.types.extend(value.map(|value| (derived.name.span, value.r#type)));
            });
        }
    }

    /// Checks laws by themselves.
    fn check_laws(&mut self, file: &'f File) {
        for law in &file.laws {
            self.check(&law.name, &law.arguments, |compiler, scope| compiler.statements(scope, &law.body));
        }
    }

    /// Writes a law or derived value with arguments of unknown value, throws the code away, and remembers whether there
    /// was a fault.
    fn check(&mut self, name: &'f Name, arguments: &'f [Argument], write: impl FnOnce(&mut Self, &mut Scope<'f>)) {
        let (mark, faults) = (self.code.mark(), self.diagnostics.len());
        let mut scope = self.scope_of_arguments(arguments);
        if !self.broken.contains(name.text.as_str()) {
            self.writing.push(&name.text);
            write(self, &mut scope);
            self.writing.pop();
        }
        self.watch_growth(name.span);
        self.code.rewind(mark);
        if self.diagnostics.len() > faults {
            self.broken.insert(&name.text);
        }
    }

    /// Remembers the item at `span` if the program has just outgrown its limits.
    fn watch_growth(&mut self, span: Span) {
        if self.code.full || self.work > super::WORK_LIMIT {
            self.outgrown.get_or_insert(span);
        }
    }

    /// Makes a state known, with places for its arguments.
    fn declare(&mut self, state: &'f State) -> Scope<'f> {
        let index = self.states.len();
        let scope = self.scope_of_arguments(&state.arguments);
        let names = state.arguments.iter().map(|argument| &argument.name.text);
        let arguments = names.map(|name| (name.clone(), scope.get(name).flatten())).collect();
        self.states.insert(&state.name.text, StateEntry { index, arguments });
        scope
    }

    fn state(&mut self, state: &'f State, mut scope: Scope<'f>, timers: &mut usize) -> machine::State {
        self.variables(&mut scope, state);
        self.doing = &state.body;
        let transitions = state.transitions.iter();
        let transitions = transitions.filter_map(|transition| self.transition(&scope, transition, timers)).collect();
        self.doing = &[];
        let start = self.code.here();
        self.statements(&mut scope, &state.body);
        let body = self.code.since(start);

        self.commandless = Some("leaving a state");
        let start = self.code.here();
        self.statements(&mut scope, &state.exit);
        let exit = self.code.since(start);
        let entry = self.entry(&mut scope, state);
        self.commandless = None;
        self.variables.clear();
        self.watch_growth(state.name.span);
        machine::State { name: Arc::from(state.name.text.as_str()), entry, body, exit, transitions }
    }

    /// Gives a state's memory its places. The values are written into the entry, which comes last, when it is known what
    /// else there is to reset.
    fn variables(&mut self, scope: &mut Scope<'f>, state: &'f State) {
        for (name, value) in &state.memory {
            let mark = self.code.mark();
            let value = self.expression(scope, value);
            self.code.rewind(mark);
            let memory = value.map(|Value { r#type, .. }| Value { r#type, register: self.code.place(r#type.width()) });
            self.bind(scope, name, memory);
            self.variables.push(&name.text);
        }
        self.memories.clear();
    }

    /// Writes what a state does when it is entered.
    fn entry(&mut self, scope: &mut Scope<'f>, state: &'f State) -> Block {
        self.commandless = Some("entering a state");
        let start = self.code.here();
        for (name, value) in &state.memory {
            // A fault of the value has been reported when its place was made.
            if let Some(memory) = scope.get(&name.text).flatten()
                && let Some(value) = self.expression(scope, value)
            {
                self.code.copy(memory.register, value.register, value.r#type.width());
            }
        }
        for (memory, count) in std::mem::take(&mut self.memories) {
            self.code.push(Op::Clear { memory, count });
        }
        self.statements(scope, &state.entry);
        self.code.since(start)
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
            let diagnostic = Diagnostic::error("P0201", message, target.name.span, "unknown state");
            let known = self.states.keys().copied().chain([FAILURE]);
            let diagnostic = did_you_mean(diagnostic, &target.name.text, known);
            self.report(match &target.text {
                Some(text) => diagnostic.hint(format!("write `Failure(\"{}\")` to end the run", text.text)),
                None => diagnostic,
            });
            return None;
        };
        let StateEntry { index: state, arguments } = entry.clone();
        if let Some(text) = &target.text {
            let message = format!("the state `{}` takes no text", target.name.text);
            let diagnostic = Diagnostic::error("P0304", message, text.span, "a reason is for a failure");
            self.report(diagnostic.hint(format!("write `Failure(\"{}\")` to end the run", text.text)));
            return None;
        }
        if target.values.len() != arguments.len() {
            let names: Vec<&str> = arguments.iter().map(|(name, _)| name.as_str()).collect();
            let usage = if names.is_empty() { String::new() } else { format!("({})", names.join(", ")) };
            let (takes, given) = (count(arguments.len()), target.values.len());
            let message = format!("the state `{}` takes {takes}, not {given}", target.name.text);
            let mut diagnostic = Diagnostic::error("P0304", message, target.span, "entered here");
            if let Some(&made) = self.items.get(target.name.text.as_str()) {
                diagnostic = diagnostic.note(made, "made here");
            }
            self.report(diagnostic.hint(format!("write `{}{usage}`", target.name.text)));
            return None;
        }
        let arguments = self.pass(scope, target, &arguments)?;
        Some(machine::Target::State { state, arguments })
    }

    /// Writes the values that a state is entered with. All are computed before the first is put into its place: a state may
    /// hand its own arguments on to itself in another order.
    fn pass(&mut self, scope: &Scope<'f>, target: &'f Target, arguments: &[(String, Meaning)]) -> Option<Block> {
        let start = self.code.here();
        let pairs = target.values.iter().zip(arguments);
        let given: Vec<Option<(Value, Value)>> = pairs
            .map(|(value, &(_, argument))| {
                let Some(argument) = argument else {
                    self.expression(scope, value);
                    return None;
                };
                Some((self.expect(scope, value, argument.r#type)?, argument))
            })
            .collect();
        let mut copies = Vec::with_capacity(given.len());
        for (value, argument) in given.into_iter().collect::<Option<Vec<_>>>()? {
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
                        .hint("keep one of them")
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
            let diagnostic = Diagnostic::error("P0201", message, name.span, "unknown state");
            self.report(did_you_mean(diagnostic, &name.text, self.states.keys().copied()));
            return None;
        };
        if !entry.arguments.is_empty() {
            self.report(
                Diagnostic::error("P0404", "the initial state cannot have arguments", name.span, "starts here")
                    .hint(format!("start in a state without arguments, and let it lead to `{}`", name.text)),
            );
            return None;
        }
        Some(entry.index)
    }
}
