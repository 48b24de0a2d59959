//! The model of a policy for analysis: names and spans from the syntax tree, semantics from the program.

use std::collections::HashMap;

use crate::ast::{self, File};
use crate::load::Files;
use crate::lower::Lowered;
use crate::types::{Type, Value};
use vibrissa_runtime::machine::{self, Program, Register};
use vibrissa_text::diagnostic::Span;

use super::data_flow::Flow;
use super::interval::Interval;
use super::unknown::Domain;

/// The model of a policy.
pub(super) struct Model<'a> {
    pub(super) file: &'a File,
    pub(super) program: &'a Program,
    pub(super) always: Vec<Edge<'a>>,
    /// All states, in the order of the program.
    pub(super) states: Vec<Node<'a>>,
    /// The names of the values of each enumeration, by the span of its name.
    choices: &'a HashMap<Span, Vec<String>>,
    flow: Flow,
}

/// A state.
pub(super) struct Node<'a> {
    pub(super) name: &'a ast::Name,
    pub(super) edges: Vec<Edge<'a>>,
    /// Target of the fallback transition.
    pub(super) failsafe: Option<&'a machine::Target>,
    /// The arguments of the state.
    pub(super) arguments: &'a [(String, Value)],
}

/// A transition with its semantics and its syntax.
#[derive(Clone, Copy)]
pub(super) struct Edge<'a> {
    /// The source state. `None` for a global transition.
    pub(super) from: Option<usize>,
    pub(super) guard: &'a machine::Guard,
    pub(super) target: &'a machine::Target,
    pub(super) written: &'a ast::Transition,
}

/// The name and type of a register.
pub(super) struct Named<'a> {
    pub(super) name: &'a str,
    pub(super) r#type: Type,
    /// The first register of the value. A vector has two registers.
    pub(super) first: Register,
    /// The names of the values 0, 1, 2 and so on, if it is not a number.
    pub(super) choices: &'a [String],
}

impl<'a> Edge<'a> {
    /// Span of the guard's condition or duration.
    pub(super) fn guard_span(&self) -> Span {
        match &self.written.guard {
            ast::Guard::When { condition, .. } => condition.span,
            ast::Guard::After(time) => time.span,
        }
    }

    /// The values for the arguments of the entered states.
    pub(super) fn values(&self) -> impl Iterator<Item = &'a ast::Expression> {
        let target = &self.written.target;
        target.outer.iter().flat_map(|step| &step.values).chain(&target.values)
    }

    /// Span of the transition, from its guard on.
    pub(super) fn span(&self) -> Span {
        self.guard_span().to(self.written.target.span)
    }

    /// The target state. `None` for the end of the run.
    pub(super) fn leads_to(&self) -> Option<usize> {
        leads_to(self.target)
    }

    /// The condition of the guard. `None` if the guard is only a duration.
    pub(super) fn condition(&self) -> Option<Condition<'a>> {
        match self.guard {
            machine::Guard::When { code, truth, .. } => Some(Condition { code, truth: *truth }),
            machine::Guard::After { .. } => None,
        }
    }

    /// True if the transition is due as soon as its condition holds.
    pub(super) fn is_immediate(&self) -> bool {
        matches!(self.guard, machine::Guard::When { lasting: None, .. })
    }
}

impl Node<'_> {
    /// The targets of the state's own transitions and of its fallback transition. `None` is the end of the run.
    pub(super) fn exits(&self) -> impl Iterator<Item = Option<usize>> {
        self.edges.iter().map(Edge::leads_to).chain(self.failsafe.map(leads_to))
    }
}

/// The state of a target. `None` for the end of the run.
fn leads_to(target: &machine::Target) -> Option<usize> {
    match target {
        machine::Target::State { state, .. } => Some(*state),
        machine::Target::Failure(_) | machine::Target::Success(_) => None,
    }
}

/// Code that computes a bool.
#[derive(Clone, Copy)]
pub(super) struct Condition<'a> {
    pub(super) code: &'a machine::Block,
    pub(super) truth: Register,
}

impl<'a> Model<'a> {
    pub(super) fn new(files: &'a Files, lowered: &'a Lowered) -> Self {
        let (file, program) = (&files.main, &lowered.program);
        let states = files.machine.states.iter().zip(&program.states).zip(&lowered.arguments);
        let states = states.enumerate().map(|(index, ((written, state), arguments))| Node {
            name: &written.name,
            edges: edges(Some(index), &state.transitions, &written.transitions),
            failsafe: program.fallback_of(index).map(|(_, target)| target),
            arguments,
        });
        Self {
            file,
            program,
            always: edges(None, &program.always, &file.always),
            states: states.collect(),
            choices: &lowered.choices,
            flow: Flow::new(program),
        }
    }

    /// True if a state has no inner states, so that it can be the innermost active state.
    pub(super) fn is_innermost(&self, state: usize) -> bool {
        self.program.states[state].initial.is_none()
    }

    /// The innermost states, with their indices.
    pub(super) fn innermost(&self) -> impl Iterator<Item = (usize, &Node<'a>)> {
        self.states.iter().enumerate().filter(|&(index, _)| self.is_innermost(index))
    }

    /// The transitions that can be taken while `innermost` is the innermost active state, except the global ones. Those
    /// of outer states come first.
    pub(super) fn active_edges(&self, innermost: usize) -> Vec<&Edge<'a>> {
        self.inward(innermost).into_iter().flat_map(|state| &self.states[state].edges).collect()
    }

    /// The transitions that precede another one while `innermost` is the innermost active state.
    pub(super) fn tried_before(&self, edge: &Edge<'_>, innermost: usize) -> Vec<&Edge<'a>> {
        let before = self.active_edges(innermost).into_iter();
        before.take_while(|before| !std::ptr::eq(before.guard, edge.guard)).collect()
    }

    /// A state and its ancestors, the outermost first.
    pub(super) fn inward(&self, state: usize) -> Vec<usize> {
        let mut ancestors: Vec<usize> = self.program.outward(state).collect();
        ancestors.reverse();
        ancestors
    }

    /// The innermost state that a transition enters while `innermost` is the innermost active state, or the state that
    /// it resumes. `None` for the end of the run, and if the target is already active.
    pub(super) fn leads_to_one(&self, edge: &Edge<'_>, innermost: usize) -> Option<usize> {
        if edge.leads_to().is_some_and(|state| self.program.is_target_active(edge.from, state, innermost)) {
            return None;
        }
        self.begins_in(edge.target)
    }

    /// The innermost state that a target enters, or the state that it resumes. `None` for the end of the run.
    pub(super) fn begins_in(&self, target: &machine::Target) -> Option<usize> {
        let machine::Target::State { state, resume, .. } = *target else { return None };
        let inner = |&state: &usize| self.program.states[state].initial.as_ref().map(|&(inner, _)| inner);
        if resume { Some(state) } else { std::iter::successors(Some(state), inner).last() }
    }

    /// The innermost states that a transition can enter while `innermost` is the innermost active state.
    pub(super) fn leads_on(&self, edge: &Edge<'_>, innermost: usize) -> Vec<usize> {
        let Some(target) = self.leads_to_one(edge, innermost) else { return Vec::new() };
        // The descendants of a state follow it directly.
        let inside = (target..self.states.len()).take_while(|&state| self.program.contains(target, state));
        inside.filter(|&state| self.is_innermost(state)).collect()
    }

    /// The name of a register.
    pub(super) fn named(&self, register: Register) -> Option<Named<'_>> {
        if let Some(parameter) = self.program.parameters.get(usize::from(register)) {
            let r#type = Type::Scalar(parameter.dimension);
            return Some(Named { name: &parameter.name, r#type, first: register, choices: &parameter.choices });
        }
        let arguments = self.states.iter().flat_map(|state| state.arguments);
        let mut arguments = arguments.map(|(name, value)| (name, value, value.register));
        arguments.find(|(_, value, first)| (*first..first + value.r#type.width()).contains(&register)).map(
            |(name, value, first)| {
                let choices = match value.r#type {
                    Type::Choice(choices) => self.choices.get(&choices.declared).map_or(&[][..], Vec::as_slice),
                    _ => &[],
                };
                Named { name, r#type: value.r#type, first, choices }
            },
        )
    }

    /// True if a register does not change while a state is active: a constant or a parameter.
    pub(super) fn is_steady(&self, register: Register) -> bool {
        !self.flow.is_written(register)
    }

    /// The domain of a register that the current code has not written. `None` if its value never changes.
    pub(super) fn domain(&self, register: Register) -> Option<Domain> {
        if let Some(parameter) = self.program.parameters.get(usize::from(register)) {
            return match parameter.choices.len() {
                0 => parameter.range.map(|(low, high)| Domain::Range(Interval::new(low, high))),
                count => Some(indices(count)),
            };
        }
        if !self.flow.is_written(register) {
            return None;
        }
        let values = self.flow.values(self.program, register);
        Some(match (values, self.named(register).map(|named| named.r#type)) {
            (Some(values), _) => Domain::Values(values),
            (None, Some(Type::Whisker)) => indices(self.program.whiskers.len()),
            (None, Some(Type::Contour)) => indices(self.program.whiskers.len() + self.program.contours.len()),
            (None, Some(Type::Bool)) => indices(2),
            (None, Some(Type::Choice(choices))) => indices(choices.count),
            (None, _) => Domain::Range(Interval::ANYTHING),
        })
    }
}

/// The domain of a number that is an index into so many things.
fn indices(count: usize) -> Domain {
    Domain::Values((0..count).map(|index| index as f64).collect())
}

fn edges<'a>(
    from: Option<usize>,
    transitions: &'a [machine::Transition],
    written: &'a [ast::Transition],
) -> Vec<Edge<'a>> {
    let pairs = transitions.iter().zip(written);
    let edge = |(transition, written): (&'a machine::Transition, _)| {
        let machine::Transition { guard, target } = transition;
        Edge { from, guard, target, written }
    };
    pairs.map(edge).collect()
}
