//! Construction of charts from syntax trees.

use std::collections::HashMap;

use crate::ast::{self, Contract, File, Step};
use crate::expand::{Expanded, Instance};
use crate::load::Files;
use crate::lower::SUCCESS;
use vibrissa_text::diagnostic::Source;

use super::{Argument, Chart, Exit, Guard, Origin, State, Target, Transition};

/// The chart of files that compile: that of the machine, or those of all behaviours of a library.
pub(crate) fn build(source: &Source, files: &Files) -> Chart {
    let file = &files.main;
    let own: Vec<&Expanded> = match files.behaviours.first() {
        Some(behaviours) if file.is_library() => behaviours.iter().collect(),
        _ => vec![&files.machine],
    };
    let mut chart = Chart {
        machine: file.name.text.clone(),
        states: Vec::new(),
        transitions: Vec::new(),
        contracts: Vec::new(),
        parents: Vec::new(),
        is_overview: false,
    };
    if !file.is_library() {
        let builder = Builder::new(source, &files.machine, (0, 0));
        chart.contracts = builder.contracts(&file.contracts);
        chart.transitions = builder.transitions(Origin::AnyState, None, &file.always, &file.failsafes);
    }
    for expanded in own {
        let builder = Builder::new(source, expanded, (chart.states.len(), chart.parents.len()));
        for index in 0..expanded.states.len() {
            let state = builder.state(index, file);
            chart.states.extend(state);
        }
        for (index, state) in expanded.states.iter().enumerate() {
            // Those of a behaviour belong to the state that uses it.
            if expanded.is_root(index)
                && let Some(user) = chart.states.get_mut(builder.places[index])
            {
                user.contracts.extend(builder.contracts(&state.contracts));
            }
            let origin = Origin::State(builder.places[index]);
            chart.transitions.extend(builder.transitions(origin, Some(index), &state.transitions, &state.failsafes));
        }
        let first = chart.parents.len();
        chart.parents.extend(expanded.states.iter().map(|state| state.parent.map(|parent| first + parent)));
    }
    // The transitions of a state and of its behaviour have one origin.
    for place in 0..chart.states.len() {
        number(&mut chart.transitions, Origin::State(place));
    }
    number(&mut chart.transitions, Origin::AnyState);
    chart
}

/// Numbers the transitions of an origin in the order in which they are tried. Fallback transitions are not tried among
/// the others.
fn number(transitions: &mut [Transition], origin: Origin) {
    let tried = transitions.iter_mut().filter(|one| one.origin == origin && one.guard != Guard::Failsafe);
    let mut tried: Vec<&mut Transition> = tried.collect();
    if tried.len() > 1 {
        tried.iter_mut().zip(1..).for_each(|(transition, number)| transition.number = Some(number));
    }
}

struct Builder<'f> {
    source: &'f Source,
    expanded: &'f Expanded,
    /// For each state, its index in the chart. The outermost state of a copy of a behaviour is drawn as the state that
    /// uses it.
    places: Vec<usize>,
    /// The index of each state by its instance and name.
    states: HashMap<(usize, &'f str), usize>,
    /// The number of states of the machine that precede these.
    offset: usize,
}

impl<'f> Builder<'f> {
    /// `drawn` and `offset` are the numbers of states that the chart and the machine already have.
    fn new(source: &'f Source, expanded: &'f Expanded, (drawn, offset): (usize, usize)) -> Self {
        let mut places: Vec<usize> = Vec::with_capacity(expanded.states.len());
        let mut next = drawn;
        for (index, state) in expanded.states.iter().enumerate() {
            match state.parent {
                Some(parent) if expanded.is_root(index) => places.push(places[parent]),
                _ => {
                    places.push(next);
                    next += 1;
                }
            }
        }
        let names = expanded.states.iter().map(|state| (state.instance, state.name.text.as_str()));
        Self { source, expanded, places, states: names.zip(0..).collect(), offset }
    }

    /// A state. `None` for the outermost state of a copy of a behaviour.
    fn state(&self, index: usize, file: &File) -> Option<State> {
        if self.expanded.is_root(index) {
            return None;
        }
        let state = &self.expanded.states[index];
        let arguments = state.arguments.iter().map(|argument| {
            let type_name = self.source.on_one_line(argument.type_name.span());
            let default = argument.default.as_ref().map(|default| self.source.on_one_line(default.span));
            let type_name = default.map_or(type_name.clone(), |default| format!("{type_name} = {default}"));
            Argument { name: argument.name.text.clone(), type_name }
        });
        let outer = state.parent.map(|parent| &self.expanded.states[parent]);
        let begin = outer.into_iter().flat_map(|outer| &outer.initial).find(|step| step.name.text == state.name.text);
        let is_first = state.instance == 0 && file.initial.iter().any(|initial| initial.text == state.name.text);
        Some(State {
            index: self.offset + index,
            name: self.name(index, file),
            arguments: arguments.collect(),
            behaviour: state.behaviour.as_ref().map(|step| self.step(step)),
            parent: state.parent.map(|parent| self.places[parent]),
            initial: is_first || begin.is_some(),
            values: begin.map_or_else(Vec::new, |step| self.texts(&step.values)),
            contracts: self.contracts(&state.contracts),
            hidden: 0,
        })
    }

    /// The texts of contracts.
    fn contracts(&self, contracts: &[Contract]) -> Vec<String> {
        contracts.iter().map(|contract| self.source.on_one_line(contract.span)).collect()
    }

    /// The name of a state, which no other one in the chart has.
    fn name(&self, index: usize, file: &File) -> String {
        let path = self.expanded.path(index);
        match self.expanded.instances.first() {
            Some(behaviour) if file.is_library() && index > 0 => format!("{}.{path}", behaviour.name.text),
            _ => path,
        }
    }

    /// A name with its values.
    fn step(&self, step: &Step) -> String {
        let values = self.texts(&step.values).join(", ");
        if values.is_empty() { step.name.text.clone() } else { format!("{}({values})", step.name.text) }
    }

    /// The transitions of the state `from`, or the global ones, and the fallback transition. A transition to an unknown
    /// state is omitted. A file that compiles has none.
    fn transitions(
        &self,
        origin: Origin,
        from: Option<usize>,
        transitions: &[ast::Transition],
        failsafes: &[ast::Target],
    ) -> Vec<Transition> {
        let instance = from.map_or(0, |from| self.expanded.states[from].instance);
        let transitions = transitions.iter().map(|transition| (self.guard(&transition.guard), &transition.target));
        let built = transitions.chain(failsafes.iter().map(|target| (Guard::Failsafe, target)));
        built
            .filter_map(|(guard, target)| {
                let mut exits = Vec::new();
                let target = self.target(instance, target, &mut exits)?;
                Some(Transition { origin, number: None, guard, exits, target })
            })
            .collect()
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

    /// A target of a transition of an instance. The exits that lead to it are added to `exits`.
    fn target(&self, instance: usize, target: &ast::Target, exits: &mut Vec<Exit>) -> Option<Target> {
        let of = |name: &ast::Name| self.states.get(&(instance, name.text.as_str())).copied();
        Some(match target {
            ast::Target { is_exit: true, name, values, .. } => {
                let Instance { user, name: behaviour, .. } = self.expanded.instances.get(instance)?;
                let values = self.texts(values);
                let Some(user) = *user else {
                    return Some(Target::Exit { behaviour: behaviour.text.clone(), name: name.text.clone(), values });
                };
                exits.push(Exit { state: self.places[user], name: name.text.clone(), values });
                let state = &self.expanded.states[user];
                let connection = state.connections.iter().find(|connection| connection.exit.text == name.text)?;
                return self.target(state.instance, &connection.target, exits);
            }
            ast::Target { text: Some(reason), name, .. } if name.text == SUCCESS => {
                Target::Success(reason.text.clone())
            }
            ast::Target { text: Some(reason), .. } => Target::Failure(reason.text.clone()),
            ast::Target { resume, outer, name, values, .. } => {
                let outer = outer.iter().map(|step| Some((self.places[of(&step.name)?], self.texts(&step.values))));
                Target::State {
                    state: self.places[of(name)?],
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
