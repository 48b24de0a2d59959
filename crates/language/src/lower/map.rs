//! `tell map.event(values)`.

use crate::ast::{Expression, Name};
use crate::builtins::MAP_EVENTS;
use crate::suggestion::did_you_mean;
use vibrissa_runtime::machine::Op;
use vibrissa_text::diagnostic::Diagnostic;

use super::Compiler;
use super::scope::Scope;

impl<'f> Compiler<'f> {
    /// Lowers an event of the map.
    pub(super) fn tell_map(&mut self, scope: &Scope<'f>, event: &'f Name, values: &'f [Expression]) -> Option<()> {
        self.allow_telling_the_map(event.span)?;
        let Some(&(_, takes, _)) = MAP_EVENTS.iter().find(|(known, ..)| *known == event.text) else {
            let message = format!("the map has no event `{}`", event.text);
            let known = MAP_EVENTS.map(|(known, ..)| known);
            let diagnostic = Diagnostic::error("P0203", message, event.span, "unknown event");
            let hint = format!("it has {}", known.join(" and "));
            self.report(did_you_mean(diagnostic, &event.text, known).hint(hint));
            return None;
        };
        if values.len() != takes.len() {
            let needed: Vec<String> = takes.iter().map(|(value, ..)| format!("a {value}")).collect();
            let needed = if needed.is_empty() { "no values".to_owned() } else { needed.join(" and ") };
            let message = format!("`map.{}` takes {needed}", event.text);
            let examples: Vec<&str> = takes.iter().map(|&(.., example)| example).collect();
            let written = match examples.join(", ") {
                given if given.is_empty() => format!("tell map.{}", event.text),
                given => format!("tell map.{}({given})", event.text),
            };
            let diagnostic = Diagnostic::error("P0304", message, event.span, "with other values");
            self.report(diagnostic.hint(format!("write `{written}`")));
            return None;
        }
        // An error in one value does not hide those in the others.
        let given: Vec<_> =
            values.iter().zip(takes).map(|(value, &(_, r#type, _))| self.expect(scope, value, r#type)).collect();
        let op = match given.as_slice() {
            [] => Op::GiveUp,
            &[Some(a), Some(b)] if event.text == "felt" => Op::Felt { a: a.register, b: b.register },
            &[Some(position), Some(heading)] => Op::GoTo { a: position.register, b: heading.register },
            _ => return None,
        };
        self.code.push(op);
        Some(())
    }
}
