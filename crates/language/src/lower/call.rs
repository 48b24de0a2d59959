//! The values of calls: those in order, those with names, and defaults.

use crate::ast::{Argument, Expression, Kind};
use crate::suggestion::did_you_mean;
use vibrissa_text::diagnostic::{Diagnostic, Span};

use super::Compiler;
use super::scope::Scope;

/// The value of an argument in a call.
#[derive(Debug, Clone, Copy)]
pub(super) struct Given<'f> {
    pub(super) value: &'f Expression,
    /// True for the default of the argument. It knows only the items of the file that declares it.
    pub(super) is_default: bool,
}

/// A law, a derived value or a state that takes values.
pub(super) struct Callee<'c> {
    /// Its name in messages, such as the state `Swiping`.
    pub(super) what: &'c str,
    /// The label of a use.
    pub(super) label: &'static str,
}

impl Callee<'_> {
    /// The value of each argument.
    ///
    /// # Errors
    /// The diagnostic for values that do not fit the arguments.
    pub(super) fn values<'f>(
        &self,
        arguments: &'f [Argument],
        values: &'f [Expression],
        span: Span,
    ) -> Result<Vec<Given<'f>>, Box<Diagnostic>> {
        let what = self.what;
        let in_order = values.iter().take_while(|value| !matches!(value.kind, Kind::Named { .. })).count();
        if in_order > arguments.len() {
            return Err(Box::new(self.count(arguments, values.len(), span)));
        }
        let mut given: Vec<Option<Given<'f>>> = values[..in_order].iter().map(|value| Some(at_call(value))).collect();
        given.resize(arguments.len(), None);
        for value in &values[in_order..] {
            let Kind::Named { name, value: inner } = &value.kind else {
                let message = "a value without a name follows one with a name";
                return Err(Box::new(Diagnostic::error("P0304", message, value.span, "has no name")));
            };
            let Some(index) = arguments.iter().position(|argument| argument.name.text == name.text) else {
                let message = format!("{what} has no argument `{}`", name.text);
                let diagnostic = Diagnostic::error("P0304", message, name.span, "unknown argument");
                let known = arguments.iter().map(|argument| argument.name.text.as_str());
                return Err(Box::new(did_you_mean(diagnostic, &name.text, known)));
            };
            if given[index].replace(at_call(inner)).is_some() {
                let message = format!("the argument `{}` has two values", name.text);
                return Err(Box::new(Diagnostic::error("P0304", message, name.span, "given again")));
            }
        }
        for (given, argument) in given.iter_mut().zip(arguments) {
            let default = argument.default.as_ref().map(|value| Given { value, is_default: true });
            *given = given.or(default);
        }
        let missing = given.iter().zip(arguments).find(|(given, _)| given.is_none()).map(|(_, argument)| argument);
        match missing {
            None => Ok(given.into_iter().flatten().collect()),
            Some(_) if in_order == values.len() && !has_defaults(arguments) => {
                Err(Box::new(self.count(arguments, values.len(), span)))
            }
            Some(argument) => {
                let message = format!("{what} needs a value for `{}`", argument.name.text);
                Err(Box::new(Diagnostic::error("P0304", message, span, self.label)))
            }
        }
    }

    fn count(&self, arguments: &[Argument], given: usize, span: Span) -> Diagnostic {
        let at_most = if has_defaults(arguments) { "at most " } else { "" };
        let message = format!("{} takes {at_most}{}, not {given}", self.what, count(arguments.len()));
        Diagnostic::error("P0304", message, span, self.label)
    }
}

fn at_call(value: &Expression) -> Given<'_> {
    Given { value, is_default: false }
}

fn has_defaults(arguments: &[Argument]) -> bool {
    arguments.iter().any(|argument| argument.default.is_some())
}

fn count(values: usize) -> String {
    match values {
        0 => "no values".to_owned(),
        1 => "1 value".to_owned(),
        more => format!("{more} values"),
    }
}

/// The notation of a call with all arguments: `Swiping(w, speed)`. The name alone if there are none.
pub(super) fn usage(name: &str, arguments: &[Argument]) -> String {
    let names: Vec<&str> = arguments.iter().map(|argument| argument.name.text.as_str()).collect();
    if names.is_empty() { name.to_owned() } else { format!("{name}({})", names.join(", ")) }
}

impl<'f> Compiler<'f> {
    /// Checks the defaults of arguments.
    pub(super) fn check_defaults(&mut self, arguments: &'f [Argument]) {
        for argument in arguments {
            if let Some(default) = &argument.default {
                let mark = self.code.mark();
                let memories = self.memories.len();
                match self.named_type(&argument.type_name) {
                    Some(r#type) => self.expect(&Scope::default(), default, r#type),
                    None => self.expression(&Scope::default(), default),
                };
                self.memories.truncate(memories);
                self.code.rewind(mark);
            }
        }
    }
}
