//! Enumerations and their values.

use std::collections::HashMap;

use crate::ast::{Enumeration, Name, TypeName};
use crate::suggestion::did_you_mean;
use crate::types::{Choices, Type, Value};
use vibrissa_text::diagnostic::{Diagnostic, Span};

use super::Compiler;

impl Enumeration {
    /// The type of its values.
    pub(super) fn r#type(&self) -> Type {
        Type::Choice(Choices { declared: self.name.span, count: self.values.len() })
    }

    /// The names of its values.
    pub(super) fn names(&self) -> Vec<String> {
        self.values.iter().map(|value| value.text.clone()).collect()
    }
}

impl<'f> Compiler<'f> {
    /// Checks that the values of an enumeration differ, and numbers them.
    pub(super) fn check_choices(&mut self, item: &'f Enumeration) {
        let mut numbers: HashMap<&'f str, usize> = HashMap::with_capacity(item.values.len());
        for (index, value) in item.values.iter().enumerate() {
            if let Some(&first) = numbers.get(value.text.as_str()) {
                let message = format!("`{}` has the value `{}` twice", item.name.text, value.text);
                let diagnostic = Diagnostic::error("P0202", message, value.span, "again here");
                self.report(diagnostic.note(item.values[first].span, "first here").hint("keep one of them"));
            }
            numbers.entry(&value.text).or_insert(index);
        }
        self.choice_numbers.insert(item.name.span, numbers);
    }

    /// The number of a value of an enumeration.
    pub(super) fn choice_number(&mut self, item: &Enumeration, value: &Name) -> Option<usize> {
        let numbers = self.choice_numbers.get(&item.name.span);
        let found = numbers.and_then(|numbers| numbers.get(value.text.as_str()).copied());
        if found.is_none() && !self.is_told("P0203", value.span) {
            let message = format!("`{}` has no value `{}`", item.name.text, value.text);
            let diagnostic = Diagnostic::error("P0203", message, value.span, "unknown value");
            let known = item.names();
            let diagnostic = did_you_mean(diagnostic, &value.text, known.iter().map(String::as_str));
            let hint = format!("its values are {}", known.join(", "));
            self.report(diagnostic.note(item.name.span, "declared here").hint(hint));
        }
        found
    }

    /// The names of the values of an enumeration, for one parameter, plot or message. Each has its own copy of them, so they count as
    /// work.
    pub(super) fn choice_names(&mut self, item: &Enumeration) -> Vec<String> {
        self.work += item.values.len();
        if self.is_exhausted() { Vec::new() } else { item.names() }
    }

    /// Lowers `Side.left`.
    pub(super) fn choice_value(&mut self, item: &'f Enumeration, value: &Name) -> Option<Value> {
        let number = self.choice_number(item, value)?;
        Some(Value { r#type: item.r#type(), register: self.code.constant(number as f64) })
    }

    /// The type with a name in the current file, if there is one.
    pub(super) fn named_type(&self, name: &TypeName) -> Option<Type> {
        let is_plain = name.of.is_none() && name.factors.is_empty();
        let own = || self.names().enumerations.get(name.base.text.as_str()).filter(|_| is_plain);
        let compound = || self.names().compounds.get(name.base.text.as_str()).filter(|_| is_plain);
        let monitor = || self.names().monitors.get(name.base.text.as_str()).filter(|_| is_plain);
        Type::named(name)
            .or_else(|| own().map(|item| item.r#type()))
            .or_else(|| Some(self.known_layout(compound()?.1.name.span)?.r#type()))
            .or_else(|| monitor().map(|(_, content)| Type::Monitor(content.name.span)))
    }

    /// A type in messages.
    pub(super) fn phrase(&self, r#type: Type) -> String {
        let name = match r#type {
            Type::Choice(choices) => self.enumerations.get(&choices.declared).map(|item| &item.name),
            Type::Compound(of) => self.known_layout(of.declared).map(|layout| layout.name),
            Type::Monitor(content) => {
                self.running.iter().map(|running| &running.content.name).find(|name| name.span == content)
            }
            _ => None,
        };
        name.map_or_else(|| r#type.to_string(), |name| format!("a `{}`", name.text))
    }

    /// The names of the values of all enumerations, by the span of the declaration.
    pub(super) fn choices(&self) -> HashMap<Span, Vec<String>> {
        self.enumerations.iter().map(|(&span, item)| (span, item.names())).collect()
    }
}
