//! Construction of charts from syntax trees.

use std::collections::HashMap;

use crate::diagnostic::Source;
use crate::policy::ast::{self, File};
use crate::policy::lower::SUCCESS;

use super::{Argument, Chart, Guard, Origin, State, Target, Transition};

/// The chart of a file that compiles.
pub(in crate::policy) fn build(source: &Source, file: &File) -> Chart {
    let names = file.states.iter().map(|state| state.name.text.as_str());
    let builder = Builder { source, states: names.zip(0..).collect() };
    let of_states = file.states.iter().zip(0..).map(|(state, index)| (Origin::State(index), state));
    let of_states =
        of_states.flat_map(|(origin, state)| builder.transitions(origin, &state.transitions, &state.failsafes));
    let always = builder.transitions(Origin::AnyState, &file.always, &file.failsafes);
    Chart {
        machine: file.name.text.clone(),
        states: file.states.iter().zip(0..).map(|(state, index)| builder.state(index, state, file)).collect(),
        transitions: always.into_iter().chain(of_states).collect(),
        parents: file.states.iter().map(|state| state.parent).collect(),
        is_overview: false,
    }
}

struct Builder<'f> {
    source: &'f Source,
    /// The index of each state.
    states: HashMap<&'f str, usize>,
}

impl Builder<'_> {
    fn state(&self, index: usize, state: &ast::State, file: &File) -> State {
        let arguments = state.arguments.iter().map(|argument| {
            let type_name = self.source.on_one_line(argument.type_name.span());
            Argument { name: argument.name.text.clone(), type_name }
        });
        let outer = state.parent.map(|parent| &file.states[parent]);
        let begin = outer.into_iter().flat_map(|outer| &outer.initial).find(|step| step.name.text == state.name.text);
        State {
            index,
            name: state.name.text.clone(),
            arguments: arguments.collect(),
            parent: state.parent,
            initial: file.initial.iter().any(|initial| initial.text == state.name.text) || begin.is_some(),
            values: begin.map_or_else(Vec::new, |step| self.texts(&step.values)),
            hidden: 0,
        }
    }

    /// The transitions from one origin, and its fallback transition. A transition to an unknown state is omitted. A
    /// file that compiles has none.
    fn transitions(
        &self,
        origin: Origin,
        transitions: &[ast::Transition],
        failsafes: &[ast::Target],
    ) -> Vec<Transition> {
        let transitions = transitions.iter().map(|transition| (self.guard(&transition.guard), &transition.target));
        let built = transitions.chain(failsafes.iter().map(|target| (Guard::Failsafe, target)));
        let mut built: Vec<Transition> = built
            .filter_map(|(guard, target)| {
                Some(Transition { origin, number: None, guard, target: self.target(target)? })
            })
            .collect();
        // A fallback transition is not tried among the others.
        let tried = built.iter_mut().filter(|transition| transition.guard != Guard::Failsafe);
        let mut tried: Vec<&mut Transition> = tried.collect();
        if tried.len() > 1 {
            tried.iter_mut().zip(1..).for_each(|(transition, number)| transition.number = Some(number));
        }
        built
    }

    fn guard(&self, guard: &ast::Guard) -> Guard {
        match guard {
            ast::Guard::When { condition, lasting } => Guard::When {
                condition: self.source.on_one_line(condition.span),
                lasting: lasting.as_ref().map(|time| self.source.on_one_line(time.span)),
            },
            ast::Guard::After(time) => Guard::After(self.source.on_one_line(time.span)),
        }
    }

    fn target(&self, target: &ast::Target) -> Option<Target> {
        Some(match target {
            ast::Target { text: Some(reason), name, .. } if name.text == SUCCESS => {
                Target::Success(reason.text.clone())
            }
            ast::Target { text: Some(reason), .. } => Target::Failure(reason.text.clone()),
            ast::Target { resume, outer, name, values, .. } => {
                let outer = outer
                    .iter()
                    .map(|step| Some((*self.states.get(step.name.text.as_str())?, self.texts(&step.values))));
                Target::State {
                    state: *self.states.get(name.text.as_str())?,
                    outer: outer.collect::<Option<_>>()?,
                    values: self.texts(values),
                    resume: resume.is_some(),
                }
            }
        })
    }

    fn texts(&self, expressions: &[ast::Expression]) -> Vec<String> {
        expressions.iter().map(|expression| self.source.on_one_line(expression.span)).collect()
    }
}
