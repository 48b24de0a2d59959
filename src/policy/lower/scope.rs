//! Names and what they stand for.

use crate::diagnostic::{Diagnostic, suggest};
use crate::policy::ast::Name;
use crate::policy::builtins::FUNCTIONS;
use crate::policy::types::Value;

use super::Compiler;

/// The names that one law, derived value or state gives to values; later ones in front.
#[derive(Debug, Clone, Default)]
pub(super) struct Scope<'f> {
    names: Vec<(&'f str, Value)>,
}

impl<'f> Scope<'f> {
    pub(super) fn get(&self, name: &str) -> Option<Value> {
        self.names.iter().rev().find(|(known, _)| *known == name).map(|&(_, value)| value)
    }

    pub(super) fn insert(&mut self, name: &'f str, value: Value) {
        self.names.push((name, value));
    }

    /// How many names there are, to [`truncate`](Self::truncate) to.
    pub(super) fn len(&self) -> usize {
        self.names.len()
    }

    /// Forgets the names that came after the first `len`.
    pub(super) fn truncate(&mut self, len: usize) {
        self.names.truncate(len);
    }
}

impl<'f> Compiler<'f> {
    /// Gives a name to a value in a scope, unless the name is taken.
    pub(super) fn bind(&mut self, scope: &mut Scope<'f>, name: &'f Name, value: Value) {
        let taken = scope.get(&name.text).is_some()
            || self.globals.contains_key(name.text.as_str())
            || self.derived.contains_key(name.text.as_str());
        if taken {
            let message = format!("the name `{}` is already taken", name.text);
            self.report(
                Diagnostic::error("P0202", message, name.span, "named again here")
                    .hint("give it a name of its own; one name means one thing"),
            );
        }
        scope.insert(&name.text, value);
    }

    /// Reports a name that stands for nothing.
    pub(super) fn unknown_name(&mut self, scope: &Scope<'f>, name: &Name) {
        let message = format!("nothing is called `{}`", name.text);
        let mut diagnostic = Diagnostic::error("P0201", message, name.span, "unknown name");
        let known = scope
            .names
            .iter()
            .map(|&(known, _)| known)
            .chain(self.globals.keys().copied())
            .chain(self.derived.keys().copied())
            .chain(FUNCTIONS.iter().map(|&(known, ..)| known))
            .chain(["time"]);
        let mut known: Vec<&str> = known.collect();
        known.sort_unstable();
        if self.laws.contains_key(name.text.as_str()) {
            diagnostic = diagnostic.hint(format!("`{0}` is a law: write `do {0}(…)`", name.text));
        } else if let Some(meant) = suggest(&name.text, known) {
            diagnostic = diagnostic.hint(format!("did you mean `{meant}`?"));
        }
        self.report(diagnostic);
    }
}
