//! Monitors: memory with statements that run first in every tick.

use std::collections::HashMap;
use std::rc::Rc;

use crate::ast::{Argument, Expression, File, Monitor, Name, State, Statement, Step};
use crate::suggestion::did_you_mean;
use crate::types::{Type, Value};
use vibrissa_text::diagnostic::{Diagnostic, Span};

use super::call::Callee;
use super::compound::WIDTH_LIMIT;
use super::scope::{Meaning, Scope};
use super::{Commandless, Compiler, DEPTH_LIMIT};

/// The work of one unknown monitor, in nodes of the syntax tree. It takes more memory than a node.
const UNKNOWN_MONITOR_WORK: usize = 8;

/// A monitor that runs, or an unknown one that a part of a policy takes as an argument and that is checked alone.
pub(super) struct Running<'f> {
    /// The file that declares its content, and its content.
    file: usize,
    pub(super) content: &'f Monitor,
    origin: Origin<'f>,
    /// Its memory.
    pub(super) memory: Vec<(&'f Name, Meaning)>,
    /// The indices of the names in it.
    places: HashMap<&'f str, usize>,
}

/// Where the values of a monitor's arguments come from.
#[derive(Clone)]
enum Origin<'f> {
    /// The values in its own declaration, which know so many names of the machine.
    Declared { declared: &'f Monitor, values: &'f [Expression], above: usize },
    /// The arguments, with unknown values.
    Unknown(Scope<'f>),
}

impl<'f> Compiler<'f> {
    /// Lowers the initialisation of a monitor's memory, and adds its name to the machine's. A monitor with arguments runs
    /// only where another one uses it.
    pub(super) fn start_monitor(&mut self, scope: &mut Scope<'f>, declared: &'f Monitor) {
        if declared.used.is_none() && !declared.arguments.is_empty() {
            return;
        }
        let meaning = self.start_declared(scope, declared);
        self.memories.clear();
        self.check_size(declared.name.span);
        scope.insert(&declared.name, meaning);
    }

    fn start_declared(&mut self, scope: &Scope<'f>, declared: &'f Monitor) -> Meaning {
        let (file, content, values) = match &declared.used {
            None => (self.current_file, declared, [].as_slice()),
            Some(Step { name, values, .. }) => {
                let Some((file, content)) = self.names().monitors.get(name.text.as_str()).copied() else {
                    if self.is_told("P0201", name.span) {
                        return None;
                    }
                    let message = format!("there is no monitor `{}`", name.text);
                    let diagnostic = Diagnostic::error("P0201", message, name.span, "unknown monitor");
                    let known = self.names().monitors.keys().copied();
                    self.report(did_you_mean(diagnostic, &name.text, known));
                    return None;
                };
                (file, content, values.as_slice())
            }
        };
        let origin = Origin::Declared { declared, values, above: scope.len() };
        let inner = self.monitor_values(scope, file, content, (declared, values))?;
        Some(self.start(file, content, origin, inner))
    }

    /// A monitor with unknown arguments and memory. `None` if no file declares its content.
    pub(super) fn unknown_monitor(&mut self, content: Span) -> Meaning {
        let &(file, content) = self.monitors.get(&content)?;
        self.work += UNKNOWN_MONITOR_WORK;
        if self.endless.contains(&content.name.span) || self.is_exhausted() {
            return None;
        }
        let faults = (self.diagnostics.len(), self.faults);
        // Errors of the content are reported where it is declared.
        let outer = std::mem::replace(&mut self.is_told_elsewhere, true);
        let inner = self.within(file, |compiler| compiler.scope_of_arguments(&content.arguments));
        let value = self.start(file, content, Origin::Unknown(inner.clone()), inner);
        self.is_told_elsewhere = outer;
        self.diagnostics.truncate(faults.0);
        self.faults = faults.1;
        Some(value)
    }

    /// Reports the monitors that take themselves as arguments, directly or through others, and those that take too long a chain of others.
    pub(super) fn check_endless_monitors(&mut self) {
        let all = self
            .files
            .iter()
            .enumerate()
            .flat_map(|(number, names)| names.monitors.values().filter(move |(file, _)| *file == number).copied());
        let mut all: Vec<(usize, &'f Monitor)> = all.collect();
        all.sort_by_key(|(_, monitor)| monitor.name.span.start);
        self.monitors = all.iter().map(|&(file, monitor)| (monitor.name.span, (file, monitor))).collect();
        let indices: HashMap<Span, usize> =
            all.iter().enumerate().map(|(index, (_, monitor))| (monitor.name.span, index)).collect();
        // The monitors that each one takes, and those that take it.
        let mut takes: Vec<Vec<usize>> = vec![Vec::new(); all.len()];
        let mut taken_by = takes.clone();
        for (index, &(file, monitor)) in all.iter().enumerate() {
            for argument in &monitor.arguments {
                let taken = self.within(file, |compiler| compiler.named_type(&argument.type_name));
                if let Some(Type::Monitor(taken)) = taken
                    && let Some(&taken) = indices.get(&taken)
                {
                    takes[index].push(taken);
                    taken_by[taken].push(index);
                }
            }
        }
        let chains = longest_paths(&takes, &taken_by);
        // Those that only take one of a cycle are in none.
        let is_taken_by_cycle = longest_paths(&taken_by, &takes);
        for (index, (_, monitor)) in all.iter().enumerate() {
            if chains[index].is_some_and(|length| length < DEPTH_LIMIT) {
                continue;
            }
            let name = &monitor.name;
            self.endless.insert(name.span);
            if chains[index] == Some(DEPTH_LIMIT) {
                let message = format!("monitors take each other more than {DEPTH_LIMIT} deep");
                let diagnostic = Diagnostic::error("P0104", message, name.span, "too deep");
                self.report(diagnostic.hint("give the values to the monitor, in place of the monitors that have them"));
            } else if chains[index].is_none() && is_taken_by_cycle[index].is_none() {
                let message = format!("the monitor `{}` takes itself as an argument", name.text);
                let diagnostic = Diagnostic::error("P0401", message, name.span, "has no end");
                self.report(
                    diagnostic.hint("a monitor takes only monitors that do not take it, also not through others"),
                );
            }
        }
    }

    fn start(&mut self, file: usize, content: &'f Monitor, origin: Origin<'f>, mut inner: Scope<'f>) -> Value {
        self.within(file, |compiler| compiler.monitor_memory(&mut inner, content));
        let memory: Vec<(&'f Name, Meaning)> =
            content.memory.iter().map(|(name, _)| (name, inner.get(&name.text).flatten())).collect();
        for value in memory.iter().filter_map(|(_, value)| *value) {
            let width = self.monitor_registers.entry(value.register).or_default();
            *width = value.r#type.width().max(*width);
        }
        let register = u16::try_from(self.running.len()).unwrap_or(u16::MAX);
        let mut places = HashMap::with_capacity(memory.len());
        for (place, (name, _)) in memory.iter().enumerate() {
            places.entry(name.text.as_str()).or_insert(place);
        }
        self.running.push(Running { file, content, origin, memory, places });
        Value { r#type: Type::Monitor(content.name.span), register }
    }

    /// The arguments of a monitor with their values. `scope` has the names of the machine above it.
    fn monitor_values(
        &mut self,
        scope: &Scope<'f>,
        file: usize,
        content: &'f Monitor,
        (declared, values): (&'f Monitor, &'f [Expression]),
    ) -> Option<Scope<'f>> {
        let span = declared.used.as_ref().map_or(declared.name.span, |step| step.span);
        self.arguments(scope, file, &content.name, &content.arguments, values, span)
    }

    /// True if a value is memory of a monitor, or a part of it.
    pub(super) fn is_of_a_monitor(&self, value: Value) -> bool {
        let first = value.register.saturating_sub(WIDTH_LIMIT);
        let mut memories = self.monitor_registers.range(first..=value.register);
        !matches!(value.r#type, Type::Monitor(_))
            && memories.any(|(&register, &width)| register.saturating_add(width) > value.register)
    }

    /// Lowers the initial values of a monitor's memory.
    fn monitor_memory(&mut self, scope: &mut Scope<'f>, monitor: &'f Monitor) {
        let variables = std::mem::take(&mut self.variables);
        self.declaring = &monitor.memory;
        for (name, value) in &monitor.memory {
            let memory = self.expression(scope, value).map(|value| self.copied(value));
            self.bind(scope, 0, name, memory);
        }
        self.declaring = &[];
        self.variables = variables;
    }

    /// Lowers the statements of all monitors. `scope` has the names of the machine.
    pub(super) fn monitor_bodies(&mut self, scope: &Scope<'f>) {
        self.own_names = Rc::new(scope.clone());
        for index in 0..self.running.len() {
            let Some((inner, content, file)) = self.inside(index) else { continue };
            self.within(file, |compiler| compiler.monitor_statements(inner, content, &content.body));
            if let Some(Running { origin: Origin::Declared { declared, .. }, .. }) = self.running.get(index) {
                self.check_size(declared.name.span);
            }
        }
        self.memories.clear();
    }

    /// The names inside of a monitor: its arguments and its memory. Also its content and the file of that.
    fn inside(&mut self, index: usize) -> Option<(Scope<'f>, &'f Monitor, usize)> {
        let Running { file, content, origin, memory, .. } = self.running.get(index)?;
        let (file, content, origin, memory) = (*file, *content, origin.clone(), memory.clone());
        // The names of the memory and of the events are looked at for every use.
        self.work += memory.len() + content.events.len();
        let mut inner = match origin {
            Origin::Unknown(arguments) => arguments,
            Origin::Declared { declared, values, above } => {
                let above_it = Scope::inside(&self.own_names, above);
                self.within(0, |compiler| compiler.monitor_values(&above_it, file, content, (declared, values)))?
            }
        };
        for (name, memory) in memory {
            inner.insert(name, memory);
        }
        Some((inner, content, file))
    }

    /// Lowers statements of a monitor.
    fn monitor_statements(&mut self, mut scope: Scope<'f>, monitor: &'f Monitor, statements: &'f [Statement]) {
        let own = monitor.memory.iter().map(|(name, _)| name).collect();
        let variables = std::mem::replace(&mut self.variables, own);
        let outside = self.commandless.replace(Commandless {
            construct: "a monitor",
            hint: "a monitor only remembers; move it to the statements of a state",
            allows_records: false,
        });
        self.statements(&mut scope, statements);
        self.commandless = outside;
        self.variables = variables;
    }

    /// Checks the monitors of a file alone, with unknown arguments, and discards the code.
    pub(super) fn check_monitors(&mut self, file: &'f File) {
        for monitor in file.monitors.iter().filter(|monitor| monitor.used.is_none()) {
            let (mark, faults) = (self.code.mark(), self.diagnostics.len());
            let mut scope = self.scope_of_arguments(&monitor.arguments);
            self.monitor_memory(&mut scope, monitor);
            self.monitor_statements(scope.clone(), monitor, &monitor.body);
            for (index, event) in monitor.events.iter().enumerate() {
                if let Some(before) = monitor.events[..index].iter().find(|before| before.name.text == event.name.text)
                {
                    let message = format!("the name `{}` is declared twice", event.name.text);
                    let diagnostic = Diagnostic::error("P0202", message, event.name.span, "declared again here");
                    self.report(diagnostic.note(before.name.span, "first declared here").hint("choose another name"));
                }
                let mut scope = scope.clone();
                let hidable = scope.len();
                self.check_defaults(&event.arguments);
                self.bind_arguments(&mut scope, hidable, &event.arguments);
                self.monitor_statements(scope, monitor, &event.body);
            }
            self.memories.clear();
            self.check_size(monitor.name.span);
            self.code.rewind(mark);
            if self.diagnostics.len() > faults {
                self.erroneous.insert(monitor.name.span);
            }
        }
    }

    /// Gives a behaviour the monitors that are its arguments. They are those of the state that uses it, and do not change.
    pub(super) fn give_monitors(&mut self, state: &'f State, scope: &mut Scope<'f>) {
        let given = |compiler: &Self, argument: &Argument| match scope.get(&argument.name.text).flatten() {
            Some(Value { r#type: Type::Monitor(_), .. }) => {
                let user = compiler.hierarchy.instances[state.instance].user;
                Some(user.filter(|_| state.parent == user))
            }
            _ => None,
        };
        let monitors: Vec<_> =
            state.arguments.iter().filter_map(|argument| Some((argument, given(self, argument)?))).collect();
        for (argument, user) in monitors {
            let Some(user) = user else {
                if !self.hierarchy.is_behaviour(state.instance) || state.parent.is_some() {
                    let message = format!("the state `{}` takes a monitor", state.name.text);
                    let diagnostic = Diagnostic::error("P0412", message, argument.name.span, "a monitor");
                    self.report(diagnostic.hint("states know the monitors of the machine; only behaviours, laws, derived values and monitors take them"));
                }
                continue;
            };
            let states = self.hierarchy.states;
            let Some(used) = &states[user].behaviour else { continue };
            // Values that do not fit are reported where the state enters the behaviour.
            let given = (Callee { what: "", label: "" }).values(&state.arguments, &used.values, used.span);
            let position = state.arguments.iter().position(|known| known.name.span == argument.name.span);
            let Some(given) = given.ok().and_then(|given| given.get(position?).copied()) else { continue };
            let outer = Rc::clone(&self.scopes[user]);
            let faults = (self.diagnostics.len(), self.faults);
            let told = std::mem::replace(&mut self.is_told_elsewhere, true);
            let value = self.within(self.hierarchy.file(user), |compiler| compiler.expression(&outer, given.value));
            self.is_told_elsewhere = told;
            self.diagnostics.truncate(faults.0);
            self.faults = faults.1;
            let value = value.filter(|value| matches!(value.r#type, Type::Monitor(_)));
            scope.insert(&argument.name, value);
        }
    }

    /// Lowers `tell monitor.event(values)`: the statements of the event, in this place.
    pub(super) fn tell(
        &mut self,
        scope: &Scope<'f>,
        [monitor, event]: [&'f Name; 2],
        values: &'f [Expression],
        span: Span,
    ) -> Option<()> {
        if monitor.text == "map" && scope.get("map").is_none() {
            return self.tell_map(scope, event, values);
        }
        let value = self.monitor_named(scope, monitor)?;
        let Running { content, file, .. } = self.running.get(usize::from(value.register))?;
        let (content, file) = (*content, *file);
        let Some(event) = content.events.iter().find(|known| known.name.text == event.text) else {
            if self.is_told("P0203", event.span) {
                return None;
            }
            let message = format!("the monitor `{}` has no event `{}`", monitor.text, event.text);
            let known: Vec<&str> = content.events.iter().map(|event| event.name.text.as_str()).collect();
            let diagnostic = Diagnostic::error("P0203", message, event.span, "unknown event");
            let hint = if known.is_empty() {
                format!("declare it in the monitor: `on {} {{ \u{2026} }}`", event.text)
            } else {
                format!("it has {}", known.join(", "))
            };
            self.report(did_you_mean(diagnostic, &event.text, known).hint(hint));
            return None;
        };
        let given = self.arguments(scope, file, &event.name, &event.arguments, values, span)?;
        let (mut inner, ..) = self.inside(usize::from(value.register))?;
        for argument in &event.arguments {
            let value = given.get(&argument.name.text).flatten().map(|value| self.untold(value));
            inner.insert(&argument.name, value);
        }
        // The event sets the memory of its monitor, also where a law tells it. There is no recursion: a monitor knows only
        // those above it.
        let (inlining, law) = (std::mem::take(&mut self.inlining), self.outer_use.take());
        let written = self.descend(span, |compiler| {
            compiler.within(file, |compiler| compiler.monitor_statements(inner, content, &event.body));
            Some(())
        });
        (self.inlining, self.outer_use) = (inlining, law);
        written
    }

    /// The monitor that a name means.
    fn monitor_named(&mut self, scope: &Scope<'f>, name: &Name) -> Option<Value> {
        let Some(value) = scope.get(&name.text) else {
            self.unknown_name(scope, name);
            return None;
        };
        let value = value?;
        if let Type::Monitor(_) = value.r#type {
            return Some(value);
        }
        let message = format!("`{}` is {}, and cannot be told anything", name.text, self.phrase(value.r#type));
        let diagnostic = Diagnostic::error("P0301", message, name.span, "not a monitor");
        self.report(diagnostic.hint("only a monitor has events"));
        None
    }

    /// The value of a monitor's memory.
    pub(super) fn monitor_member(&mut self, monitor: Value, name: &Name) -> Option<Value> {
        let running = self.running.get(usize::from(monitor.register))?;
        if let Some(&(_, value)) = running.places.get(name.text.as_str()).and_then(|&place| running.memory.get(place)) {
            return value;
        }
        if self.is_told("P0203", name.span) {
            return None;
        }
        let running = self.running.get(usize::from(monitor.register))?;
        let monitor = match &running.origin {
            Origin::Declared { declared, .. } => &declared.name.text,
            Origin::Unknown(_) => &running.content.name.text,
        };
        let message = format!("the monitor `{monitor}` has no `{}`", name.text);
        let known: Vec<&str> = running.memory.iter().map(|(name, _)| name.text.as_str()).collect();
        let diagnostic = Diagnostic::error("P0203", message, name.span, "unknown memory");
        let hint = if known.is_empty() { "it has no `var`".to_owned() } else { format!("it has {}", known.join(", ")) };
        let diagnostic = did_you_mean(diagnostic, &name.text, known).hint(hint);
        self.report(diagnostic);
        None
    }
}

/// For every node of a graph, the number of edges of the longest path from it. `None` if it leads to a cycle. `edges` and `reversed` are
/// the edges in both directions.
fn longest_paths(edges: &[Vec<usize>], reversed: &[Vec<usize>]) -> Vec<Option<usize>> {
    let mut left: Vec<usize> = edges.iter().map(Vec::len).collect();
    let mut open: Vec<usize> = (0..left.len()).filter(|&node| left[node] == 0).collect();
    let (mut lengths, mut longest) = (vec![None; left.len()], vec![0; left.len()]);
    while let Some(node) = open.pop() {
        lengths[node] = Some(longest[node]);
        for &before in &reversed[node] {
            longest[before] = longest[before].max(longest[node] + 1);
            left[before] -= 1;
            if left[before] == 0 {
                open.push(before);
            }
        }
    }
    lengths
}
