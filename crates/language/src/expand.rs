//! Expansion of behaviours: every use becomes a copy of the behaviour's states inside the state that uses it.
//!
//! After it, the later stages know only states. Each copy is an [`Instance`]. The names of its states, arguments and
//! memory are known only within it.

use std::collections::HashMap;
use std::sync::Arc;

use vibrissa_runtime::machine::NESTING_LIMIT;
use vibrissa_text::diagnostic::{Diagnostic, FAULT_LIMIT, Span};

use super::ast::{Behaviour, Connection, Exit, File, Name, State, Step};
use super::suggestion::did_you_mean;

/// The maximum total length of the texts of all copies in a machine (bytes), with the paths of their names. It bounds memory and
/// time of the compilation. All behaviours that are checked alone have as much together.
const COPIED_LIMIT: usize = 1 << 20;

/// States that share one set of names: those of the machine, or those of one copy of a behaviour.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Instance {
    /// The number of the file that contains the text. The policy has the number 0.
    pub(super) file: usize,
    /// Index of the state that uses the behaviour. `None` for the machine, and for a behaviour that is checked alone.
    pub(super) user: Option<usize>,
    /// The name of the behaviour, or that of the machine.
    pub(super) name: Name,
    /// The exits of the behaviour.
    pub(super) exits: Arc<Vec<Exit>>,
    /// The names of the states before those of the copy, each with a `.` behind it.
    pub(super) prefix: String,
}

/// A machine, or a behaviour that is checked alone, with copies of all behaviours that it uses.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Expanded {
    /// An outer state precedes its inner states.
    pub(super) states: Vec<State>,
    /// The states of the machine, or of the behaviour itself, are instance 0.
    pub(super) instances: Vec<Instance>,
    pub(super) faults: Vec<Diagnostic>,
}

impl Expanded {
    /// The name of a state in the whole machine: `Following.Swiping`.
    pub(super) fn path(&self, state: usize) -> String {
        self.states
            .get(state)
            .map_or_else(String::new, |state| format!("{}{}", self.instances[state.instance].prefix, state.name.text))
    }

    /// True if a state is the outermost one of a copy of a behaviour.
    pub(super) fn is_root(&self, state: usize) -> bool {
        self.states
            .get(state)
            .is_some_and(|state| state.parent.is_some_and(|parent| self.states[parent].instance != state.instance))
    }
}

/// Expands the machine of the first file.
pub(super) fn machine(behaviours: &Behaviours<'_>) -> Expanded {
    let Some(file) = behaviours.files.first() else {
        return Expanded { states: Vec::new(), instances: Vec::new(), faults: Vec::new() };
    };
    expand(behaviours, (0, &file.name), (&file.states, Arc::default()), &mut 0)
}

/// Expands every behaviour of a file alone, so that it is checked wherever it is used. `copied` counts the copies of all files
/// (bytes). The behaviours behind the one that exceeds the limit are left out.
pub(super) fn alone(behaviours: &Behaviours<'_>, number: usize, copied: &mut usize) -> Vec<Expanded> {
    let mut expanded = Vec::new();
    for behaviour in behaviours.files.get(number).into_iter().flat_map(|file| &file.behaviours) {
        if *copied > COPIED_LIMIT {
            break;
        }
        let content = (behaviour.states.as_slice(), Arc::clone(&behaviour.root().exits));
        expanded.push(expand(behaviours, (number, &behaviour.name), content, copied));
    }
    expanded
}

fn expand(
    behaviours: &Behaviours<'_>,
    (file, name): (usize, &Name),
    (states, exits): (&[State], Arc<Vec<Exit>>),
    copied: &mut usize,
) -> Expanded {
    let whole = Instance { file, user: None, name: name.clone(), exits, prefix: String::new() };
    let whole = Expanded { states: Vec::new(), instances: vec![whole], faults: Vec::new() };
    let mut expansion = Expansion { behaviours, whole, copied: *copied, open: Vec::new() };
    // A behaviour that is checked alone cannot use itself.
    if states.first().is_some_and(|root| root.name.span == name.span) {
        expansion.open.push(name.span);
    }
    expansion.copy(states, 0, None);
    *copied = expansion.copied;
    expansion.whole
}

/// The files of a policy, with their behaviours.
pub(super) struct Behaviours<'f> {
    /// The policy comes first.
    files: &'f [&'f File],
    /// For every `use` of every file, the index of the used library.
    links: &'f [Vec<usize>],
    /// The behaviours of every file, by their names. Of several with the same name, the first one.
    named: Vec<HashMap<&'f str, &'f Behaviour>>,
}

impl<'f> Behaviours<'f> {
    pub(super) fn new(files: &'f [&'f File], links: &'f [Vec<usize>]) -> Self {
        let named = |file: &&'f File| {
            let behaviours = file.behaviours.iter().rev();
            behaviours.map(|behaviour| (behaviour.name.text.as_str(), behaviour)).collect()
        };
        Self { files, links, named: files.iter().map(named).collect() }
    }

    /// The behaviour that a name means in a file, and the number of its file.
    fn find(&self, file: usize, name: &str) -> Option<(usize, &'f Behaviour)> {
        let own = |number: usize| Some((number, *self.named.get(number)?.get(name)?));
        own(file).or_else(|| self.imports(file, name).find_map(own))
    }

    /// The numbers of the files from which a file imports `name`.
    fn imports(&self, file: usize, name: &str) -> impl Iterator<Item = usize> {
        let uses = self.files.get(file).into_iter().flat_map(|file| &file.uses);
        let links = self.links.get(file).into_iter().flatten();
        let is_chosen = move |names: &Option<Vec<Name>>| {
            names.as_ref().is_none_or(|names| names.iter().any(|chosen| chosen.text == name))
        };
        uses.zip(links).filter(move |(used, _)| is_chosen(&used.names)).map(|(_, &link)| link + 1)
    }

    /// The names of the behaviours that a file knows.
    fn known(&self, file: usize) -> impl Iterator<Item = &'f str> {
        let all = self.files.iter().flat_map(|file| &file.behaviours).map(|behaviour| behaviour.name.text.as_str());
        all.filter(move |name| self.find(file, name).is_some())
    }
}

struct Expansion<'f> {
    behaviours: &'f Behaviours<'f>,
    whole: Expanded,
    /// Length of all copied texts (bytes).
    copied: usize,
    /// The behaviours that are being copied, by the spans of their names.
    open: Vec<Span>,
}

impl Expansion<'_> {
    fn report(&mut self, fault: Diagnostic) {
        if !self.is_full() && !self.whole.faults.contains(&fault) {
            self.whole.faults.push(fault);
        }
    }

    /// True if there are enough faults, so that nothing more is checked.
    fn is_full(&self) -> bool {
        self.whole.faults.len() >= FAULT_LIMIT
    }

    /// Appends the states of an instance. `parent` is the state that uses it.
    fn copy(&mut self, states: &[State], instance: usize, parent: Option<usize>) {
        self.check_names(states, instance);
        let mut places = Vec::with_capacity(states.len());
        for state in states {
            let place = self.whole.states.len();
            places.push(place);
            let parent = state.parent.map_or(parent, |outer| places.get(outer).copied());
            self.whole.states.push(State { parent, instance, ..state.clone() });
            self.check_parts(state, instance);
            if let Some(used) = &state.behaviour {
                self.apply(state, place, used);
            }
        }
    }

    /// Copies the behaviour that a state uses.
    fn apply(&mut self, state: &State, place: usize, used: &Arc<Step>) {
        let file = self.whole.instances[self.whole.states[place].instance].file;
        if !state.initial.is_empty() {
            let message = format!("the state `{}` has a behaviour and an `initial`", state.name.text);
            let fault = Diagnostic::error("P0420", message, used.span, "its content");
            self.report(fault.hint("a behaviour has its own inner states; remove `initial` and the inner states"));
        }
        let Some((number, behaviour)) = self.behaviours.find(file, &used.name.text) else {
            let behaviours = self.behaviours;
            let message = format!("there is no behaviour `{}`", used.name.text);
            let fault = Diagnostic::error("P0201", message, used.name.span, "unknown behaviour");
            // All copies have the same fault.
            let is_same = |known: &Diagnostic| known.code == fault.code && known.primary.span == fault.primary.span;
            if !self.is_full() && !self.whole.faults.iter().any(is_same) {
                self.report(did_you_mean(fault, &used.name.text, behaviours.known(file)));
            }
            return;
        };
        if self.open.contains(&behaviour.name.span) {
            let message = format!("the behaviour `{}` uses itself", used.name.text);
            let fault = Diagnostic::error("P0401", message, used.name.span, "used within itself");
            self.report(
                fault
                    .note(behaviour.name.span, "declared here")
                    .hint("recursion is not possible, because the work of a tick is bounded; use transitions instead"),
            );
            return;
        }
        self.check_connections(state, behaviour, used);
        let prefix = format!("{}.", self.whole.path(place));
        self.copied += behaviour.span.end - behaviour.span.start + prefix.len();
        if self.copied > COPIED_LIMIT {
            let fault =
                Diagnostic::error("P0402", "the compiled policy is too large", used.span, "exceeds the limit here");
            self.report(fault.hint("a behaviour is copied at every use; use it in fewer places"));
            return;
        }
        // The state that is too deep is reported where states are declared.
        let depth = std::iter::successors(Some(place), |&state| self.whole.states[state].parent).count();
        if depth > NESTING_LIMIT {
            return;
        }
        self.whole.instances.push(Instance {
            file: number,
            user: Some(place),
            name: behaviour.name.clone(),
            exits: Arc::clone(&behaviour.root().exits),
            prefix,
        });
        if let Some(user) = self.whole.states.get_mut(place) {
            user.initial = vec![Arc::clone(used)];
        }
        self.open.push(behaviour.name.span);
        self.copy(&behaviour.states, self.whole.instances.len() - 1, Some(place));
        self.open.pop();
    }

    /// Reports two states, or two exits, of a behaviour with the same name. Those of a machine are checked with its
    /// other items.
    fn check_names(&mut self, states: &[State], instance: usize) {
        let Some(root) = states.first().filter(|root| root.name.span == self.whole.instances[instance].name.span)
        else {
            return;
        };
        let exits: Vec<&Name> = root.exits.iter().map(|exit| &exit.name).collect();
        let states: Vec<&Name> = states.iter().map(|state| &state.name).collect();
        for names in [states, exits] {
            let mut known: HashMap<&str, Span> = HashMap::new();
            for name in names {
                if let Some(&before) = known.get(name.text.as_str()) {
                    let message = format!("the name `{}` is declared twice", name.text);
                    let fault = Diagnostic::error("P0202", message, name.span, "declared again here");
                    self.report(fault.note(before, "first declared here").hint("choose another name"));
                }
                known.insert(&name.text, name.span);
            }
        }
    }

    /// Reports parts of a state that it cannot have.
    fn check_parts(&mut self, state: &State, instance: usize) {
        let Instance { name, .. } = &self.whole.instances[instance];
        let is_behaviour = name.span == state.name.span;
        let misplaced_exit = state.exits.first().filter(|_| !is_behaviour).map(|exit| exit.name.span);
        if let Some(span) = misplaced_exit {
            let message = "only a behaviour has exits";
            let fault = Diagnostic::error("P0420", message, span, "in a state");
            self.report(fault.hint(
                "write statements in braces, `exit { \u{2026} }`, or declare the exit in the braces of a behaviour",
            ));
        }
        if let Some(connection) = state.connections.first().filter(|_| state.behaviour.is_none()) {
            let message = format!("the state `{}` has no behaviour whose exits it could connect", state.name.text);
            let fault = Diagnostic::error("P0420", message, connection.exit.span, "connects an exit");
            self.report(fault.hint(format!(
                "write `state {} is behaviour(values) {{ \u{2026} }}`, or a transition with `when`",
                state.name.text
            )));
        }
        let parent = self.whole.states.last().and_then(|state| state.parent).map(|parent| &self.whole.states[parent]);
        if let Some(parent) = parent.filter(|parent| parent.instance == instance && parent.behaviour.is_some()) {
            let message = format!("the state `{}` has a behaviour, and its own inner states", parent.name.text);
            let fault = Diagnostic::error("P0420", message, state.name.span, "an inner state");
            self.report(fault.hint("a behaviour is the whole content of a state; move the inner state out of it"));
        }
    }

    /// Reports exits of a behaviour that a state does not connect, and connections of other names.
    fn check_connections(&mut self, state: &State, behaviour: &Behaviour, used: &Step) {
        let exits = &behaviour.root().exits;
        for exit in exits.iter() {
            if self.is_full() {
                return;
            }
            let mut connections = state.connections.iter().filter(|connection| connection.exit.text == exit.name.text);
            let Some(first) = connections.next() else {
                let (name, exit_name) = (&behaviour.name.text, &exit.name.text);
                let message =
                    format!("the state `{}` does not connect the exit `{exit_name}` of `{name}`", state.name.text);
                let names: Vec<&str> = exit.arguments.iter().map(|argument| argument.name.text.as_str()).collect();
                let names = if names.is_empty() { String::new() } else { format!("({})", names.join(", ")) };
                let fault = Diagnostic::error("P0421", message, used.name.span, "has this exit");
                self.report(
                    fault
                        .note(exit.name.span, "declared here")
                        .hint(format!("write `on {exit_name}{names} -> Target` in the state")),
                );
                continue;
            };
            if let Some(second) = connections.next() {
                let message = format!("the exit `{}` is connected twice", exit.name.text);
                let fault = Diagnostic::error("P0421", message, second.exit.span, "connected again here");
                self.report(fault.note(first.exit.span, "first connected here").hint("keep one of them"));
            }
        }
        for connection in &state.connections {
            if self.is_full() {
                return;
            }
            self.check_connection(connection, behaviour);
        }
    }

    fn check_connection(&mut self, connection: &Connection, behaviour: &Behaviour) {
        let exits = &behaviour.root().exits;
        let name = &connection.exit.text;
        let Some(exit) = exits.iter().find(|exit| exit.name.text == *name) else {
            let message = format!("the behaviour `{}` has no exit `{name}`", behaviour.name.text);
            let fault = Diagnostic::error("P0201", message, connection.exit.span, "unknown exit");
            let known = exits.iter().map(|exit| exit.name.text.as_str());
            let list = known.clone().map(|name| format!("`{name}`")).collect::<Vec<_>>();
            let list = if list.is_empty() { "it has none".to_owned() } else { format!("it has {}", list.join(", ")) };
            self.report(did_you_mean(fault, name, known).hint(list));
            return;
        };
        let (takes, given) = (exit.arguments.len(), connection.names.len());
        if takes != given {
            let names: Vec<&str> = exit.arguments.iter().map(|argument| argument.name.text.as_str()).collect();
            let usage = if names.is_empty() { name.clone() } else { format!("{name}({})", names.join(", ")) };
            let message = format!("the number of values of the exit `{name}` is {takes}, not {given}");
            let fault = Diagnostic::error("P0304", message, connection.exit.span, "connected here");
            self.report(fault.note(exit.name.span, "declared here").hint(format!("write `on {usage} -> \u{2026}`")));
        }
    }
}
