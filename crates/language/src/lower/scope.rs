//! Scopes.

use std::collections::{BTreeMap, BTreeSet};
use std::rc::Rc;

use crate::ast::{Expression, Name, Statement};
use crate::builtins::{self, FUNCTIONS};
use crate::foreign_syntax::advice_for;
use crate::standard;
use crate::suggestion::did_you_mean;
use crate::types::{Type, Value};
use vibrissa_runtime::units::parse_unit;
use vibrissa_runtime::units::suggest;
use vibrissa_text::diagnostic::{Diagnostic, Span};

use super::Compiler;
use super::structure::{FAILURE, SUCCESS};

/// The meaning of a name: a value, or `None` if the value has an error that has been reported.
pub(super) type Meaning = Option<Value>;

/// The names that a law, derived value or state declares, with those of the outer states. Later ones take precedence.
#[derive(Debug, Clone, Default)]
pub(super) struct Scope<'f> {
    /// The names around it, which precede the own ones.
    outer: Option<Rc<Self>>,
    /// Number of the outer names, of which only so many are known.
    outer_len: usize,
    /// Outer names that are not known.
    hidden: BTreeSet<&'f str>,
    own: Vec<Known<'f>>,
    /// For every own name, the index of its last declaration.
    last: BTreeMap<&'f str, usize>,
}

/// A name in a scope.
#[derive(Debug, Clone)]
struct Known<'f> {
    name: &'f Name,
    meaning: Meaning,
    /// The index of the previous own declaration of the same name.
    before: Option<usize>,
}

impl<'f> Scope<'f> {
    /// A scope inside another one, which knows the first `len` of its names. It shares them, because thousands of states may be
    /// inside one state.
    pub(super) fn inside(outer: &Rc<Self>, len: usize) -> Self {
        Self { outer: Some(Rc::clone(outer)), outer_len: len, ..Self::default() }
    }

    pub(super) fn get(&self, name: &str) -> Option<Meaning> {
        self.find(name).map(|(_, known)| known.meaning)
    }

    /// Span of the declaration of a name.
    pub(super) fn given(&self, name: &str) -> Option<Span> {
        self.find(name).map(|(_, known)| known.name.span)
    }

    pub(super) fn insert(&mut self, name: &'f Name, meaning: Meaning) {
        let before = self.last.insert(&name.text, self.own.len());
        self.own.push(Known { name, meaning, before });
    }

    /// The own names that have a value.
    pub(super) fn own_values(&self) -> Vec<(String, Value)> {
        self.own.iter().filter_map(|known| Some((known.name.text.clone(), known.meaning?))).collect()
    }

    /// Number of names, for [`truncate`](Self::truncate).
    pub(super) fn len(&self) -> usize {
        self.outer_len + self.own.len()
    }

    /// Removes the own names after the first `len` names.
    pub(super) fn truncate(&mut self, len: usize) {
        while self.len() > len
            && let Some(Known { name, before, .. }) = self.own.pop()
        {
            match before {
                Some(before) => self.last.insert(&name.text, before),
                None => self.last.remove(name.text.as_str()),
            };
        }
    }

    /// The scope without the names of `hidden`.
    pub(super) fn without(&self, hidden: &'f [(Name, Expression)]) -> Self {
        if hidden.is_empty() {
            return self.clone();
        }
        let inner = Self::inside(&Rc::new(self.clone()), self.len());
        Self { hidden: hidden.iter().map(|(name, _)| name.text.as_str()).collect(), ..inner }
    }

    /// True if a value is in registers of the meaning of a name that `is_wanted`.
    pub(super) fn has_part(&self, value: Value, is_wanted: impl Fn(&str) -> bool) -> bool {
        let mut level = Some(self);
        while let Some(scope) = level {
            let memory = |known: &Known<'f>| known.meaning.is_some_and(|memory| value.is_part_of(memory));
            let mut parts = (scope.outer_len..).zip(&scope.own).filter(|(_, known)| memory(known));
            // A later declaration hides the name.
            let is_known = |index: usize, name: &str| self.find(name).is_some_and(|(last, _)| last == index);
            if parts.any(|(index, part)| is_wanted(&part.name.text) && is_known(index, &part.name.text)) {
                return true;
            }
            level = scope.outer.as_deref();
        }
        false
    }

    /// All names.
    fn names(&self) -> Vec<&'f str> {
        let mut names = Vec::with_capacity(self.len());
        let mut level = Some(self);
        while let Some(scope) = level {
            names.extend(scope.own.iter().map(|known| known.name.text.as_str()));
            level = scope.outer.as_deref();
        }
        names.retain(|name| self.find(name).is_some());
        names
    }

    /// The last declaration of a name, and its index.
    fn find(&self, name: &str) -> Option<(usize, &Known<'f>)> {
        self.find_before(name, self.len())
    }

    /// The last declaration of a name among the first `len`.
    fn find_before(&self, name: &str, len: usize) -> Option<(usize, &Known<'f>)> {
        let mut index = self.last.get(name).copied();
        while let Some(own) = index {
            let known = self.own.get(own)?;
            if self.outer_len + own < len {
                return Some((self.outer_len + own, known));
            }
            index = known.before;
        }
        let outer = self.outer.as_ref().filter(|_| !self.hidden.contains(name))?;
        outer.find_before(name, len.min(self.outer_len))
    }
}

impl<'f> Compiler<'f> {
    /// Binds a name to a value, unless an item of the file or a name of the scope has the same name.
    ///
    /// The first `hidable` names, those of outer states and of the machine, may be declared again. They are hidden
    /// then.
    pub(super) fn bind(&mut self, scope: &mut Scope<'f>, hidable: usize, name: &'f Name, meaning: Meaning) {
        let own = scope.find(&name.text).filter(|&(index, _)| index >= hidable);
        let before = own.map(|(_, known)| known.name.span);
        match before.or_else(|| self.names().item(&name.text)) {
            _ if is_reserved(&name.text) => self.report(reserved(name)),
            Some(before) => self.report(taken(name, before)),
            None => {}
        }
        self.note_type(name, meaning);
        scope.insert(name, meaning);
    }

    /// Advice for the name of an item that is no value here.
    fn item_advice(&self, text: &str) -> String {
        let names = self.names();
        if names.memory.contains(text) {
            format!("`{text}` is memory of the machine; give it to a behaviour or a monitor as an argument")
        } else if names.is_monitor(text) {
            format!(
                "`{text}` is a monitor; states and global transitions can read its memory, unless it has arguments and is only used by others"
            )
        } else if names.behaviours.contains(text) {
            format!("`{text}` is a behaviour; a state uses it: `state Name is {text}(\u{2026}) {{ \u{2026} }}`")
        } else {
            format!("`{text}` is a state; only transitions lead there: `when \u{2026} -> {text}`")
        }
    }

    /// Reports an unknown name.
    pub(super) fn unknown_name(&mut self, scope: &Scope<'f>, name: &Name) {
        if self.is_told("P0201", name.span) {
            return;
        }
        let message = format!("there is no name `{}`", name.text);
        let diagnostic = Diagnostic::error("P0201", message, name.span, "unknown name");
        let text = &name.text;
        if let Some(advice) = advice_for(text) {
            self.report(diagnostic.hint(advice));
            return;
        }
        let diagnostic = if self.names().laws.contains_key(text.as_str()) {
            diagnostic.hint(format!("`{text}` is a law: write `do {text}(\u{2026})`"))
        } else if let Some(item) = self.names().enumerations.get(text.as_str()) {
            let example = item.values.first().map_or("", |value| &value.text);
            diagnostic.hint(format!("`{text}` is a type; write one of its values, such as `{text}.{example}`"))
        } else if text == "run" {
            diagnostic.hint("`run` can only be used in the expectations of a `test`")
        } else if let Some(memory) = self.declaring.iter().find(|(known, _)| known.text == *text) {
            diagnostic.note(memory.0.span, "given here").hint(
                "a `var` can read only those above it; a name of the state hides the same name of an outer state in the whole state",
            )
        } else if self.variables.contains(text) {
            // Code that may access memory at all knows the state's memory where it is declared, and that of the
            // machine.
            diagnostic.hint(if self.inlining.is_empty() && self.figures.is_none() {
                format!("`{text}` is memory of the machine; a `var` of the machine can read only those above it")
            } else {
                format!(
                    "`{text}` is memory of the machine, which states and global transitions can read; pass it to a law or a derived value \
                     as an argument"
                )
            })
        } else if self.names().items.contains_key(text.as_str()) {
            // Every other named thing is a value.
            diagnostic.hint(self.item_advice(text))
        } else if self.state_body.iter().any(|known| matches!(known, Statement::Let { name, .. } if name.text == *text))
        {
            diagnostic.hint(format!(
                "transitions are tried before the statements of the state: write `let {text} = \u{2026}` outside of the state"
            ))
        } else if parse_unit(text).is_ok() {
            diagnostic.hint(format!("`{text}` is a unit: a unit follows a number and has no spaces: `5 mm/s`"))
        } else {
            let known = scope.names().into_iter();
            let known = known.chain(self.names().globals.keys().copied()).chain(self.names().derived.keys().copied());
            let known = known.chain(self.names().enumerations.keys().chain(self.names().compounds.keys()).copied());
            let known = known.chain(FUNCTIONS.iter().map(|&(known, ..)| known)).chain(["map", "time", "state_time"]);
            let diagnostic = in_the_standard_library(did_you_mean(diagnostic, text, known), text);
            let is_whisker =
                |(_, meaning): &(&&str, &Meaning)| meaning.is_some_and(|value| value.r#type == Type::Whisker);
            let mut whiskers: Vec<_> =
                self.names().globals.iter().filter(is_whisker).map(|(&known, _)| known).collect();
            whiskers.sort_unstable();
            match suggest(text, whiskers) {
                Some(whisker) if whisker.to_lowercase() == text.to_lowercase() => diagnostic,
                Some(whisker) => {
                    diagnostic.hint(format!("to use another whisker of the rig, bind it: `whisker {whisker}, {text}`"))
                }
                None => diagnostic,
            }
        };
        self.report(diagnostic);
    }
}

/// Adds advice to a diagnostic if the standard library contains `name`.
pub(super) fn in_the_standard_library(diagnostic: Diagnostic, name: &str) -> Diagnostic {
    match standard::module_with(name) {
        Some(module) => {
            diagnostic.hint(format!("the standard library has it: `use {}.{module} ({name})`", standard::ROOT))
        }
        None => diagnostic,
    }
}

/// True if the language reserves a name.
pub(crate) fn is_reserved(name: &str) -> bool {
    builtins::function(name).is_some() || ["map", "time", "state_time", "run", FAILURE, SUCCESS].contains(&name)
}

/// The diagnostic for a reserved name.
pub(super) fn reserved(name: &Name) -> Diagnostic {
    let message = format!("the name `{}` is reserved", name.text);
    Diagnostic::error("P0202", message, name.span, "declared here").hint("choose another name")
}

/// The diagnostic for a name that is already declared.
pub(super) fn taken(name: &Name, before: Span) -> Diagnostic {
    let message = format!("the name `{}` is declared twice", name.text);
    Diagnostic::error("P0202", message, name.span, "declared again here")
        .note(before, "first declared here")
        .hint("choose another name; only arguments and `var` of a state may repeat a name of an outer state, or of the machine's memory")
}
