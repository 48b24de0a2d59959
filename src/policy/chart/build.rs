//! From the syntax tree to the chart.

use std::collections::HashMap;

use crate::diagnostic::{Source, Span};
use crate::policy::ast::{self, File};

use super::{Argument, Chart, Guard, Origin, State, Target, Transition};

/// The chart of a file that compiles.
pub(in crate::policy) fn build(source: &Source, file: &File) -> Chart {
    let names = file.states.iter().map(|state| state.name.text.as_str());
    let builder = Builder { source, states: names.zip(0..).collect() };
    let always = file.always.iter().map(|rule| (Origin::AnyState, rule));
    let of_states = file.states.iter().enumerate();
    let of_states =
        of_states.flat_map(|(index, state)| state.transitions.iter().map(move |t| (Origin::State(index), t)));
    let transitions = always.chain(of_states);
    Chart {
        machine: file.name.text.clone(),
        states: file.states.iter().map(|state| builder.state(state, file)).collect(),
        transitions: transitions.filter_map(|(origin, transition)| builder.transition(origin, transition)).collect(),
    }
}

struct Builder<'f> {
    source: &'f Source,
    /// The index of each state.
    states: HashMap<&'f str, usize>,
}

impl Builder<'_> {
    fn state(&self, state: &ast::State, file: &File) -> State {
        let arguments = state.arguments.iter().map(|argument| {
            let type_name = self.text(argument.type_name.span());
            Argument { name: argument.name.text.clone(), type_name }
        });
        State {
            name: state.name.text.clone(),
            arguments: arguments.collect(),
            parent: None,
            initial: file.initial.iter().any(|initial| initial.text == state.name.text),
        }
    }

    /// A transition; `None` if it leads to a state that does not exist, which a file that compiles does not have.
    fn transition(&self, origin: Origin, transition: &ast::Transition) -> Option<Transition> {
        let guard = match &transition.guard {
            ast::Guard::When { condition, lasting } => Guard::When {
                condition: self.text(condition.span),
                lasting: lasting.as_ref().map(|time| self.text(time.span)),
            },
            ast::Guard::After(time) => Guard::After(self.text(time.span)),
        };
        let target = match &transition.target {
            ast::Target { text: Some(reason), .. } => Target::Failure(reason.text.clone()),
            ast::Target { name, values, .. } => Target::State {
                state: *self.states.get(name.text.as_str())?,
                values: values.iter().map(|value| self.text(value.span)).collect(),
            },
        };
        Some(Transition { origin, guard, target })
    }

    /// The text of an expression or a type, without comments, its parts one blank apart at most.
    fn text(&self, span: Span) -> String {
        // An expression holds no texts in quotes, so that every `#` begins a comment.
        let lines = self.source.slice(span).lines().map(|line| line.split('#').next().unwrap_or_default());
        lines.flat_map(str::split_whitespace).collect::<Vec<_>>().join(" ")
    }
}
