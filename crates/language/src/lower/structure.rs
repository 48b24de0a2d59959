//! The whole machine: items, states, transitions.

use std::rc::Rc;
use std::sync::Arc;

use crate::ast::{Argument, File, Guard, Name, State, Target, Transition};
use crate::expand::Expanded;
use crate::load::Files;
use crate::suggestion::did_you_mean;
use crate::types::{Type, Value};
use vibrissa_runtime::machine::{self, Block, NESTING_LIMIT, Op, Program, Register};
use vibrissa_runtime::signal::MAX_WHISKERS;
use vibrissa_text::diagnostic::{Diagnostic, Span};

use super::hierarchy::Hierarchy;
use super::scope::Scope;
use super::{Commandless, Compiler, StateEntry};

/// The targets that end a run. No state may have these names.
pub(crate) const FAILURE: &str = "Failure";
pub(crate) const SUCCESS: &str = "Success";
/// Advice for a command in `entry` or `exit`, which cannot give commands.
const COMMAND_ADVICE: &str =
    "move it to the statements of the state, which the tick that enters the state also executes";

/// The length of the names of a state's memory that counts as one visited node (bytes).
const NAMES_PER_WORK: usize = 64;

/// Checks the items of a policy and its libraries, and all laws and derived values separately. Returns the parameters
/// of the policy.
pub(super) fn items<'f>(compiler: &mut Compiler<'f>, files: &'f Files) -> Vec<machine::Parameter> {
    compiler.gather_names(files);
    compiler.check_endless_monitors();
    let parameters = compiler.parameters(&files.main);
    compiler.whiskers(&files.main);
    compiler.declare_contours(&files.main);
    for (number, file) in files.libraries.iter().chain([&files.main]).enumerate() {
        // The policy has the number 0 and is checked last.
        compiler.current_file = (number + 1) % (files.libraries.len() + 1);
        // Tests ensure that the standard library has no errors.
        if compiler.current_file > 0 && file.is_standard && compiler.types.is_none() {
            continue;
        }
        compiler.check_derived(file);
        compiler.check_laws(file);
        compiler.check_monitors(file);
    }
    for (number, behaviours) in files.behaviours.iter().enumerate() {
        compiler.current_file = number;
        for behaviour in behaviours {
            compiler.check_behaviour(behaviour);
        }
    }
    compiler.current_file = 0;
    parameters
}

/// Reports a program that exceeds its limits, at the item where this happened. `last` is used if the last item exceeded
/// them.
pub(super) fn report_size(compiler: &mut Compiler<'_>, last: Span) {
    compiler.check_size(last);
    if let Some(item) = compiler.oversized_item {
        compiler.report(
            Diagnostic::error("P0402", "the compiled policy is too large", item, "exceeds the limit here")
                .hint("laws and derived values are inlined at every use; use them in fewer places"),
        );
    }
}

/// Checks a policy and generates its program. `None` if there is no initial state.
pub(super) fn machine<'f>(compiler: &mut Compiler<'f>, files: &'f Files) -> Option<Program> {
    let file = &files.main;
    // Laws and derived values come first and cannot access this memory. Their error messages mention it.
    compiler.variables = file.memory.iter().map(|(name, _)| name).collect();
    let parameters = items(compiler, files);
    let (scope, entry, monitors) = compiler.own_memory(file);
    let body = compiler.own_body(&scope, file);
    // The registers of all arguments must exist before any transition is lowered.
    compiler.declare(&files.machine, &scope);
    compiler.memory.machine = compiler.parts(scope.own_values());
    let mut timers = 0;
    let always = compiler.transitions(&scope, None, &file.always, &mut timers);
    let fallback = compiler.failsafe(&scope, None, &file.failsafes);
    let contracts = compiler.contracts(&scope, &file.contracts);
    let states = compiler.lower_states(&mut timers);
    let initial = compiler.initial(file);
    let contact_estimators = compiler.contact_estimators(file);
    let (keypoints, contours) = compiler.contours(file);
    let needs = compiler.needs(file);
    compiler.check_whisker_arguments(file, &files.machine);
    compiler.tests(file, &parameters);

    report_size(compiler, file.name.span);
    Some(Program {
        name: file.name.text.clone(),
        whiskers: file.whiskers.iter().map(|whisker| whisker.text.clone()).collect(),
        contact_estimators,
        optional: file.optional.clone(),
        keypoints,
        contours,
        needs,
        parameters,
        states,
        initial: initial?,
        // The optimiser adds code that is executed once per run.
        start: 0..0,
        entry,
        monitors,
        body,
        always,
        contracts,
        fallback,
        outputs: std::mem::take(&mut compiler.code.outputs),
        code: std::mem::take(&mut compiler.code.ops),
        initial_registers: std::mem::take(&mut compiler.code.initial),
        timers,
    })
}

impl<'f> Compiler<'f> {
    /// Reports states with a whisker as argument if the machine has no whisker.
    fn check_whisker_arguments(&mut self, file: &'f File, machine: &'f Expanded) {
        if !file.whiskers.is_empty() {
            return;
        }
        let arguments =
            machine.states.iter().flat_map(|state| state.arguments.iter().map(move |argument| (state, argument)));
        for (state, argument) in arguments.filter(|(_, argument)| argument.type_name.base.text == "whisker") {
            let message = format!("the state `{}` takes a whisker, but the policy binds none", state.name.text);
            let diagnostic = Diagnostic::error("P0412", message, argument.name.span, "no whisker to pass");
            self.report(diagnostic.hint("bind a whisker of the rig: `whisker r0`"));
        }
    }

    fn parameters(&mut self, file: &'f File) -> Vec<machine::Parameter> {
        let mut parameters = Vec::new();
        for parameter in &file.parameters {
            let meaning = self.parameter(parameter).map(|(checked, r#type)| {
                let register = self.code.allocate(1);
                self.code.initial[usize::from(register)] = checked.default;
                parameters.push(checked);
                Value { r#type, register }
            });
            self.check_size(parameter.name.span);
            self.note_type(&parameter.name, meaning);
            self.names_mut().globals.insert(&parameter.name.text, meaning);
        }
        parameters
    }

    fn whiskers(&mut self, file: &'f File) {
        if let Some(extra) = file.whiskers.get(MAX_WHISKERS) {
            let message = format!("a policy can bind {MAX_WHISKERS} whiskers at most");
            let diagnostic = Diagnostic::error("P0403", message, extra.span, "one too many");
            self.report(diagnostic.hint("bind only the whiskers that the policy reads"));
        }
        for (index, whisker) in file.whiskers.iter().enumerate() {
            let register = self.code.constant(index as f64);
            self.names_mut().globals.insert(&whisker.text, Some(Value { r#type: Type::Whisker, register }));
        }
    }

    /// The contact estimator of every whisker.
    fn contact_estimators(&mut self, file: &'f File) -> Vec<machine::ContactEstimatorKind> {
        let mut kinds = Vec::with_capacity(file.whiskers.len());
        let mut faulty = None;
        for model in &file.tip_models {
            let kind = model.as_ref().map_or(Some(machine::ContactEstimatorKind::default()), |name| {
                machine::ContactEstimatorKind::named(&name.text)
            });
            if let (None, Some(name)) = (kind, model)
                && faulty != Some(name.span)
            {
                faulty = Some(name.span);
                let message = format!("there is no contact estimator `{}`", name.text);
                let known = machine::ContactEstimatorKind::ALL.map(machine::ContactEstimatorKind::name);
                let list = known.map(|name| format!("`{name}`")).join(", ");
                let diagnostic = Diagnostic::error("P0414", message, name.span, "is none");
                self.report(did_you_mean(diagnostic, &name.text, known).hint(format!("contact estimators are {list}")));
            }
            kinds.push(kind.unwrap_or_default());
        }
        kinds
    }

    /// Checks derived values separately.
    fn check_derived(&mut self, file: &'f File) {
        for derived in &file.derived {
            self.check(&derived.name, &derived.arguments, |compiler, scope| {
                let value = compiler.expression(scope, &derived.value);
                compiler.note_type(&derived.name, value);
            });
        }
    }

    /// Checks laws separately.
    fn check_laws(&mut self, file: &'f File) {
        for law in &file.laws {
            self.check(&law.name, &law.arguments, |compiler, scope| compiler.statements(scope, &law.body));
        }
    }

    /// Lowers a law or derived value with unknown arguments, discards the code, and records an error.
    fn check(&mut self, name: &'f Name, arguments: &'f [Argument], write: impl FnOnce(&mut Self, &mut Scope<'f>)) {
        let (mark, faults) = (self.code.mark(), self.diagnostics.len());
        self.check_defaults(arguments);
        let mut scope = self.scope_of_arguments(arguments);
        if !self.erroneous.contains(&name.span) {
            self.inlining.push(name);
            write(self, &mut scope);
            self.inlining.pop();
        }
        self.check_size(name.span);
        self.code.rewind(mark);
        if self.diagnostics.len() > faults {
            self.erroneous.insert(name.span);
        }
    }

    /// Records the item at `span` if the program has just exceeded its limits.
    pub(super) fn check_size(&mut self, span: Span) {
        if self.code.full || self.work > super::WORK_LIMIT {
            self.oversized_item.get_or_insert(span);
        }
    }

    /// Lowers the statements outside of all states.
    fn own_body(&mut self, scope: &Scope<'f>, file: &'f File) -> Block {
        self.commandless = Some(Commandless {
            construct: "the machine itself",
            hint: "move it to the statements of a state",
            allows_records: true,
        });
        let start = self.code.here();
        self.statements(&mut scope.clone(), &file.body);
        let body = self.code.since(start);
        self.commandless = None;
        self.check_size(file.acts.unwrap_or(file.name.span));
        body
    }

    /// Declares all states, with registers for their arguments and memory. `own` are the names of the machine, which the
    /// copies of behaviours do not know.
    fn declare(&mut self, expanded: &'f Expanded, own: &Scope<'f>) {
        expanded.faults.iter().for_each(|fault| self.report(fault.clone()));
        self.hierarchy = Hierarchy::new(expanded);
        let own = Rc::new(own.clone());
        self.states.clear();
        self.scopes.clear();
        self.memory.states.clear();
        for (index, state) in expanded.states.iter().enumerate() {
            if self.hierarchy.outward(index).count() == NESTING_LIMIT + 1 {
                let message = format!("states are nested more than {NESTING_LIMIT} deep");
                let diagnostic = Diagnostic::error("P0410", message, state.name.span, "this one is too deep");
                self.report(diagnostic.hint("use fewer levels of states; a behaviour is one level, too"));
            }
            let mut scope = match state.parent {
                _ if expanded.is_root(index) => Scope::default(),
                Some(parent) => Scope::inside(&self.scopes[parent], self.scopes[parent].len()),
                None => Scope::inside(&own, own.len()),
            };
            self.within(self.hierarchy.file(index), |compiler| compiler.declare_state(index, state, &mut scope));
            let memory = if self.is_exhausted() { Vec::new() } else { self.parts(scope.own_values()) };
            self.work += memory.iter().map(|(name, _)| name.len()).sum::<usize>() / NAMES_PER_WORK;
            self.memory.states.push(memory);
            self.scopes.push(Rc::new(scope));
        }
    }

    fn declare_state(&mut self, index: usize, state: &'f State, scope: &mut Scope<'f>) {
        let start = scope.len();
        self.check_defaults(&state.arguments);
        self.bind_arguments(scope, start, &state.arguments);
        self.give_monitors(state, scope);
        let names = state.arguments.iter().map(|argument| &argument.name.text);
        let arguments = names.map(|name| (name.clone(), scope.get(name).flatten())).collect();
        self.states.insert((state.instance, &state.name.text), StateEntry { index, arguments });
        // A state's own memory hides that of outer states in the whole state, also before its declaration.
        self.declaring = &state.memory;
        let mut known = scope.without(&state.memory);
        // This code is discarded.
        self.entered = Some(0);
        for (name, value) in &state.memory {
            let memory = self.remember(&known, value);
            self.bind(scope, start, name, memory);
            known.insert(name, memory);
        }
        (self.declaring, self.entered) = (&[], None);
    }

    /// Lowers all declared states.
    fn lower_states(&mut self, timers: &mut usize) -> Vec<machine::State> {
        // The memory that each state can set.
        let own = std::mem::take(&mut self.variables);
        let mut variables: Vec<Rc<[&'f Name]>> = Vec::with_capacity(self.hierarchy.states.len());
        let (own_variables, none): (Rc<[&'f Name]>, _) = (Rc::from(&*own), Rc::from([]));
        let mut lowered = Vec::with_capacity(self.hierarchy.states.len());
        for (index, state) in self.hierarchy.states.iter().enumerate() {
            // There are enough errors, or the policy is too large, which has been noted.
            if self.is_exhausted() {
                break;
            }
            let outer = match state.parent {
                Some(parent) if self.hierarchy.states[parent].instance != state.instance => &none,
                Some(parent) => &variables[parent],
                None => &own_variables,
            };
            self.variables = outer.iter().copied().chain(state.memory.iter().map(|(name, _)| name)).collect();
            let outer = Rc::clone(outer);
            // Thousands of states may share the memory of an outer one.
            variables.push(if state.memory.is_empty() { outer } else { Rc::from(&*self.variables) });
            let mut scope = Scope::clone(&self.scopes[index]);
            lowered.push(self.within(self.hierarchy.file(index), |compiler| {
                compiler.connections(index, state);
                compiler.state(index, state, &mut scope, timers)
            }));
        }
        self.variables = own;
        lowered
    }

    /// Checks a behaviour alone, with unknown arguments, and discards the code.
    fn check_behaviour(&mut self, behaviour: &'f Expanded) {
        let mark = self.code.mark();
        let variables = std::mem::take(&mut self.variables);
        self.declare(behaviour, &Scope::default());
        self.lower_states(&mut 0);
        self.variables = variables;
        self.check_size(behaviour.instances[0].name.span);
        self.code.rewind(mark);
    }

    fn state(&mut self, index: usize, state: &'f State, scope: &mut Scope<'f>, timers: &mut usize) -> machine::State {
        self.memories.clear();
        // The optimiser removes it from states that do not read it.
        let entered = self.code.allocate(1);
        self.entered = Some(entered);
        self.state_body = &state.body;
        self.current_state = Some(index);
        let transitions = self.transitions(scope, Some(index), &state.transitions, timers);
        let fallback = self.failsafe(scope, Some(index), &state.failsafes);
        let contracts = self.contracts(scope, &state.contracts);
        self.state_body = &[];
        let start = self.code.here();
        self.statements(scope, &state.body);
        let body = self.code.since(start);
        let initial = self.inner_initial(scope, index, state);

        self.commandless =
            Some(Commandless { construct: "leaving a state", hint: COMMAND_ADVICE, allows_records: true });
        let start = self.code.here();
        self.statements(scope, &state.exit);
        let exit = self.code.since(start);
        let entry = self.entry(scope, state, entered);
        (self.commandless, self.entered, self.current_state) = (None, None, None);
        self.check_size(state.name.span);
        let name = Arc::from(self.hierarchy.path(index));
        machine::State { name, parent: state.parent, initial, entry, body, exit, transitions, contracts, fallback }
    }

    /// Lowers the entry of a state.
    fn entry(&mut self, scope: &mut Scope<'f>, state: &'f State, entered: Register) -> Block {
        self.commandless =
            Some(Commandless { construct: "entering a state", hint: COMMAND_ADVICE, allows_records: true });
        let start = self.code.here();
        self.code.push(Op::Time { to: entered });
        self.set_memory(scope, &state.memory);
        for (memory, count) in std::mem::take(&mut self.memories) {
            self.code.push(Op::Clear { memory, count });
        }
        self.statements(scope, &state.entry);
        // Reset at every entry, because this memory belongs to one activation of the state.
        for (memory, count) in std::mem::take(&mut self.memories) {
            self.code.push(Op::Clear { memory, count });
        }
        self.code.since(start)
    }

    /// Lowers the transitions of the state `from`, or the global ones: first all guards, then the targets.
    fn transitions(
        &mut self,
        scope: &Scope<'f>,
        from: Option<usize>,
        transitions: &'f [Transition],
        timers: &mut usize,
    ) -> Vec<machine::Transition> {
        let guards: Vec<Option<machine::Guard>> =
            transitions.iter().map(|transition| self.guard(scope, &transition.guard, timers)).collect();
        let written = guards.into_iter().zip(transitions).filter_map(|(guard, transition)| {
            // There are enough errors, or the policy is too large, which has been noted.
            let target = if self.is_exhausted() { None } else { self.target(scope, from, &transition.target) };
            Some(machine::Transition { guard: guard?, target: target? })
        });
        written.collect()
    }

    fn guard(&mut self, scope: &Scope<'f>, guard: &'f Guard, timers: &mut usize) -> Option<machine::Guard> {
        let start = self.code.here();
        match guard {
            Guard::When { condition, lasting } => {
                let truth = self.expect(scope, condition, Type::Bool);
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
        }
    }

    /// Lowers the fallback transition of the state `from` or of the machine. There is at most one.
    fn failsafe(&mut self, scope: &Scope<'f>, from: Option<usize>, failsafes: &'f [Target]) -> Option<machine::Target> {
        let mut written = failsafes.iter().map(|target| (target.span, self.target(scope, from, target)));
        let (first, failsafe) = written.next()?;
        let others: Vec<Span> = written.map(|(span, _)| span).collect();
        for second in others {
            let message = "a state or a machine has at most one `failsafe`";
            let diagnostic = Diagnostic::error("P0411", message, second, "a second `failsafe`");
            self.report(diagnostic.note(first, "the first").hint("keep one of them"));
        }
        failsafe
    }
}
