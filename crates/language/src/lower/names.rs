//! The names of each file: its own items, and imported ones.

use std::collections::{HashMap, HashSet};

use crate::ast::{Compound, Derived, Enumeration, File, Law, Monitor, Name, Use};
use crate::load::Files;
use crate::suggestion::did_you_mean;
use vibrissa_text::diagnostic::{Diagnostic, Span};

use super::Compiler;
use super::scope::{Meaning, is_reserved, reserved, taken};

/// The names of one file.
#[derive(Debug, Default)]
pub(super) struct Names<'f> {
    /// Spans of the declarations of items and of the machine's memory.
    pub(super) items: HashMap<&'f str, Span>,
    /// Names of the machine's memory, which laws and derived values do not know.
    pub(super) memory: HashSet<&'f str>,
    /// Parameters, whiskers and contours.
    pub(super) globals: HashMap<&'f str, Meaning>,
    /// Contours of positions, by their indices among these.
    pub(super) contours: HashMap<&'f str, u16>,
    /// Derived values and laws, each with the number of its file.
    pub(super) derived: HashMap<&'f str, (usize, &'f Derived)>,
    pub(super) laws: HashMap<&'f str, (usize, &'f Law)>,
    pub(super) enumerations: HashMap<&'f str, &'f Enumeration>,
    /// Records and lists, each with the number of its file.
    pub(super) compounds: HashMap<&'f str, (usize, &'f Compound)>,
    /// The names of behaviours.
    pub(super) behaviours: HashSet<&'f str>,
    /// The names of monitors that use others.
    pub(super) running: HashSet<&'f str>,
    /// The monitors that others can use, each with the number of its file.
    pub(super) monitors: HashMap<&'f str, (usize, &'f Monitor)>,
}

impl Names<'_> {
    /// True if a name means a monitor.
    pub(super) fn is_monitor(&self, name: &str) -> bool {
        self.monitors.contains_key(name) || self.running.contains(name)
    }

    /// Span of the declaration of an item that the whole file knows.
    pub(super) fn item(&self, name: &str) -> Option<Span> {
        self.items.get(name).copied().filter(|_| !self.memory.contains(name))
    }
}

impl<'f> Compiler<'f> {
    /// The names of the current file.
    pub(super) fn names(&self) -> &Names<'f> {
        &self.files[self.current_file]
    }

    pub(super) fn names_mut(&mut self) -> &mut Names<'f> {
        &mut self.files[self.current_file]
    }

    /// Lowers a part of another file.
    pub(super) fn within<T>(&mut self, file: usize, write: impl FnOnce(&mut Self) -> T) -> T {
        let before = std::mem::replace(&mut self.current_file, file);
        let written = write(self);
        self.current_file = before;
        written
    }

    /// Collects the names of all files. The policy comes first.
    pub(super) fn gather_names(&mut self, files: &'f Files) {
        let all: Vec<&'f File> = std::iter::once(&files.main).chain(&files.libraries).collect();
        self.files.resize_with(all.len(), Names::default);
        for (number, file) in all.iter().enumerate() {
            self.within(number, |compiler| compiler.own_names(number, file));
        }
        for (number, file) in all.iter().enumerate() {
            let mut whole = HashSet::new();
            for (used, &library) in file.uses.iter().zip(files.links.get(number).into_iter().flatten()) {
                // All items of the same library again are the same.
                if used.names.is_none() && !whole.insert(library) {
                    continue;
                }
                if let Some(other) = files.libraries.get(library) {
                    self.within(number, |compiler| compiler.import(used, library + 1, other));
                }
            }
        }
        self.gather_compounds(files);
    }

    /// Collects the file's own items. Each name may be declared once per file.
    fn own_names(&mut self, number: usize, file: &'f File) {
        let parameters = file.parameters.iter().map(|parameter| &parameter.name);
        let derived = file.derived.iter().map(|derived| &derived.name);
        let laws = file.laws.iter().map(|law| &law.name);
        let enumerations = file.enumerations.iter().map(|item| &item.name);
        let compounds = file.compounds.iter().map(|item| &item.name);
        let states = file.states.iter().map(|state| &state.name);
        let behaviours = file.behaviours.iter().map(|behaviour| &behaviour.name);
        let monitors = file.monitors.iter().map(|monitor| &monitor.name);
        let memory = file.memory.iter().map(|(name, _)| name);
        let contours = file.contours.iter().map(|contour| &contour.name);
        for name in file
            .whiskers
            .iter()
            .chain(contours)
            .chain(parameters)
            .chain(derived)
            .chain(laws)
            .chain(enumerations)
            .chain(compounds)
            .chain(states)
            .chain(behaviours)
            .chain(monitors)
            .chain(memory)
        {
            if is_reserved(&name.text) {
                self.report(reserved(name));
            } else if let Some(&before) = self.names().items.get(name.text.as_str()) {
                self.report(taken(name, before));
            } else {
                self.names_mut().items.insert(&name.text, name.span);
            }
        }
        let names = self.names_mut();
        names.memory = file.memory.iter().map(|(name, _)| name.text.as_str()).collect();
        names.derived = file.derived.iter().map(|item| (item.name.text.as_str(), (number, item))).collect();
        let contents = file.monitors.iter().filter(|item| item.used.is_none());
        names.behaviours = file.behaviours.iter().map(|item| item.name.text.as_str()).collect();
        let running = file.monitors.iter().filter(|item| item.used.is_some());
        names.running = running.map(|item| item.name.text.as_str()).collect();
        names.monitors = contents.map(|item| (item.name.text.as_str(), (number, item))).collect();
        names.laws = file.laws.iter().map(|item| (item.name.text.as_str(), (number, item))).collect();
        names.enumerations = file.enumerations.iter().map(|item| (item.name.text.as_str(), item)).collect();
        names.compounds = file.compounds.iter().map(|item| (item.name.text.as_str(), (number, item))).collect();
        for item in &file.enumerations {
            self.enumerations.insert(item.name.span, item);
            self.check_choices(item);
        }
    }

    /// Imports the items of the library `other`, file `number`, for the `use` `used`.
    fn import(&mut self, used: &'f Use, number: usize, other: &'f File) {
        let chosen: Vec<(&'f Name, Span)> = match &used.names {
            None => other.exports().map(|name| (name, used.span)).collect(),
            Some(names) => {
                let mut own: HashMap<&'f str, &'f Name> = HashMap::new();
                for name in other.exports() {
                    own.entry(&name.text).or_insert(name);
                }
                names.iter().filter_map(|name| self.choose(name, other, &own)).collect()
            }
        };
        for (name, span) in chosen {
            match self.names().items.get(name.text.as_str()) {
                Some(&before) if before != name.span => {
                    let message = format!("the name `{}` is declared twice", name.text);
                    let fault = Diagnostic::error("P0202", message, span, format!("imports `{}`", name.text))
                        .note(before, "given here")
                        .note(name.span, "and here");
                    let hint = match &used.names {
                        None => "list the needed names in parentheses after it: `use \u{2026} (name, name)`",
                        Some(_) => "remove it from the list, or rename the other",
                    };
                    self.report(fault.hint(hint));
                }
                _ => {
                    let text = name.text.as_str();
                    let its = &self.files[number];
                    let derived = its.derived.get(text).copied().filter(|(_, item)| item.name.span == name.span);
                    let law = its.laws.get(text).copied().filter(|(_, item)| item.name.span == name.span);
                    let enumeration = its.enumerations.get(text).copied().filter(|item| item.name.span == name.span);
                    let compound = its.compounds.get(text).copied().filter(|(_, item)| item.name.span == name.span);
                    let monitor = its.monitors.get(text).copied().filter(|(_, item)| item.name.span == name.span);
                    let is_behaviour = its.behaviours.contains(text);
                    let names = self.names_mut();
                    names.items.insert(text, name.span);
                    names.enumerations.extend(enumeration.map(|item| (text, item)));
                    names.compounds.extend(compound.map(|item| (text, item)));
                    names.derived.extend(derived.map(|item| (text, item)));
                    names.laws.extend(law.map(|item| (text, item)));
                    names.behaviours.extend(is_behaviour.then_some(text));
                    names.monitors.extend(monitor.map(|item| (text, item)));
                }
            }
        }
    }

    /// The meaning of a name in the list of a `use`.
    fn choose(&mut self, name: &'f Name, other: &File, own: &HashMap<&'f str, &'f Name>) -> Option<(&'f Name, Span)> {
        let found = own.get(name.text.as_str()).map(|&known| (known, name.span));
        if found.is_none() && !self.is_told("P0205", name.span) {
            let message = format!("the library `{}` has no `{}`", other.name.text, name.text);
            let known: Vec<&str> = other.exports().map(|known| known.text.as_str()).collect();
            let fault = Diagnostic::error("P0205", message, name.span, "unknown name");
            let list = known.iter().map(|known| format!("`{known}`")).collect::<Vec<_>>().join(", ");
            self.report(did_you_mean(fault, &name.text, known).hint(format!("it has {list}")));
        }
        found
    }
}
