//! `plot` and `log`: copies of values, and counts that tell when they were made.

use std::sync::Arc;

use crate::ast::{Expression, Name};
use crate::types::{Type, Value};
use vibrissa_runtime::machine::{
    DESCRIPTION_LIMIT, MESSAGE_LIMIT, Message, MessageValue, NUMBERS_LIMIT, Op, OutputKind, PLOT_LIMIT, Plot, Register,
};
use vibrissa_text::diagnostic::{Diagnostic, Span};

use super::Compiler;
use super::scope::Scope;

impl<'f> Compiler<'f> {
    /// Lowers `plot name = value`.
    pub(super) fn plot(&mut self, scope: &Scope<'f>, name: &Name, value: &'f Expression) -> Option<()> {
        let shown = self.expression(scope, value)?;
        let kind = match (shown.r#type, self.output_kind(shown.r#type)) {
            (_, Some(kind)) if kind.width() == 1 && kind != OutputKind::Whisker => kind,
            (other, _) => {
                let advice = "plot a number, a bool or a value of an enumeration, such as a component `.x` of a vector";
                return self.mismatch(value.span, other, advice);
            }
        };
        let known = self.code.outputs.plots.iter().find(|plot| plot.name == name.text);
        if let Some(known) = known
            && known.kind != kind
        {
            let message = format!("the plot `{}` has values of another type before", name.text);
            let label = format!("is {}", self.phrase(shown.r#type));
            let diagnostic = Diagnostic::error("P0417", message, value.span, label);
            self.report(
                diagnostic.hint("give it another name; all values of a plot are of one type and share one axis"),
            );
            return None;
        }
        let (to, number) = match known {
            Some(known) => (known.value, known.number),
            None => self.new_plot(name, kind)?,
        };
        self.code.copy(to, shown.register, 1);
        self.count(number);
        Some(())
    }

    /// The registers of the value and of the number of a new plot.
    fn new_plot(&mut self, name: &Name, kind: OutputKind) -> Option<(Register, Register)> {
        if self.code.outputs.plots.len() == PLOT_LIMIT {
            let message = format!("a policy has {PLOT_LIMIT} plots at most");
            let diagnostic = Diagnostic::error("P0417", message, name.span, "one too many");
            self.report(diagnostic.hint("plot only what you look at; statements may share a plot by its name"));
            return None;
        }
        let (value, number) = (self.code.allocate(1), self.code.allocate(1));
        self.code.outputs.plots.push(Plot { name: name.text.clone(), kind, value, number });
        Some((value, number))
    }

    /// Lowers `log "text", values`.
    pub(super) fn log(&mut self, scope: &Scope<'f>, text: &Name, values: &'f [Expression], span: Span) -> Option<()> {
        let shown: Vec<Option<(Value, OutputKind)>> =
            values.iter().map(|value| self.logged_value(scope, value)).collect();
        let shown: Vec<(Value, OutputKind)> = shown.into_iter().collect::<Option<_>>()?;
        let fault = if text.text.len() > DESCRIPTION_LIMIT {
            Some((format!("the text of a message has {DESCRIPTION_LIMIT} bytes at most"), text.span, "shorten it"))
        } else if shown.iter().map(|(_, kind)| kind.width()).sum::<usize>() > NUMBERS_LIMIT {
            let message = format!("a message shows {NUMBERS_LIMIT} numbers at most, and a vector is two");
            Some((message, span, "write two messages"))
        } else if self.code.outputs.messages.len() == MESSAGE_LIMIT {
            let message = format!("a policy has {MESSAGE_LIMIT} messages at most");
            Some((message, span, "a message of a behaviour counts for each state that uses it"))
        } else {
            None
        };
        if let Some((message, at, hint)) = fault {
            self.report(Diagnostic::error("P0417", message, at, "exceeds the limit").hint(hint));
            return None;
        }
        let text = self.plain_text(text, "a message")?;
        let copies = shown.into_iter().map(|(value, kind)| MessageValue {
            // Names are added later, from the source.
            name: Arc::from(""),
            value: self.copied(value).register,
            kind,
        });
        let values_shown: Vec<MessageValue> = copies.collect();
        let number = self.code.allocate(1);
        self.count(number);
        self.code.outputs.messages.push(Message { state: self.current_state, text, values: values_shown, number });
        self.code.logged.push(values.iter().map(|value| value.span).collect());
        Some(())
    }

    fn logged_value(&mut self, scope: &Scope<'f>, value: &'f Expression) -> Option<(Value, OutputKind)> {
        let shown = self.expression(scope, value)?;
        match self.output_kind(shown.r#type) {
            Some(kind) => Some((shown, kind)),
            None => self.mismatch(
                value.span,
                shown.r#type,
                "log a number, a bool, a value of an enumeration, a vector or a whisker",
            ),
        }
    }

    /// Emits the count of a plot or a message.
    fn count(&mut self, to: Register) {
        if self.code.outputs.counter == 0 {
            // A constant with the number 0 would be shared. The counter is not 0, because the number of the plot or message
            // is allocated before.
            self.code.outputs.counter = self.code.allocate(1);
        }
        let counter = self.code.outputs.counter;
        self.code.push(Op::Count { to, counter });
    }

    fn output_kind(&mut self, of: Type) -> Option<OutputKind> {
        Some(match of {
            Type::Bool => OutputKind::Truth,
            Type::Scalar(dimension) => OutputKind::Number(dimension),
            r#type if let Some(dimension) = r#type.components() => OutputKind::Vector(dimension),
            Type::Whisker => OutputKind::Whisker,
            Type::Choice(choices) => {
                let item = self.enumerations.get(&choices.declared).copied()?;
                OutputKind::Choice(self.choice_names(item))
            }
            _ => return None,
        })
    }
}
