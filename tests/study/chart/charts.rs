//! Charts to draw.

use proptest::prelude::*;
use vibrissa::diagnostic::Source;
use vibrissa::policy::chart;
use vibrissa::policy::chart::{Argument, Chart, Guard, Origin, State, Target, Transition};

pub(crate) const THESIS: &str = include_str!("../../../policies/thesis.fsm");
/// Ten states with all that makes a chart hard to draw.
pub(crate) const HARD: &str = include_str!("../../fixtures/charts/hard.fsm");
/// Three levels of states.
pub(crate) const NESTED: &str = include_str!("../../fixtures/charts/nested.fsm");

pub(crate) fn state(name: &str, parent: Option<usize>, initial: bool) -> State {
    State {
        index: 0,
        name: name.to_owned(),
        arguments: Vec::new(),
        behaviour: None,
        parent,
        initial,
        contracts: Vec::new(),
        values: Vec::new(),
        hidden: 0,
    }
}

pub(crate) fn into(state: usize, values: Vec<String>) -> Target {
    Target::State { state, outer: Vec::new(), values, resume: false }
}

pub(crate) fn chart_of(text: &str) -> Chart {
    chart(&Source::new("policy.fsm", text)).unwrap()
}

/// A chart of up to 12 states, in one another or not, with texts of any length.
pub(crate) fn charts() -> impl Strategy<Value = Chart> {
    let text = prop_oneof!["[a-z.]{1,12}( [a-z0-9<>|]{1,30}){0,12}", "[a-z]{1,120}", "\\PC{0,40}"];
    let transition = (0..14_usize, 0..13_usize, text.clone(), prop::option::of(text));
    let states = prop::collection::vec(("[A-Z][a-z]{0,30}", 0..4_usize), 1..12);
    (states, prop::collection::vec(transition, 0..40), any::<prop::sample::Index>()).prop_map(
        |(states, transitions, initial)| {
            let count = states.len();
            // Each state lies beside the one before it, in it, or beside one around it.
            let mut parents: Vec<Option<usize>> = vec![None];
            for (before, (_, depth)) in states[1..].iter().enumerate() {
                let around = std::iter::successors(Some(before), |&state| parents[state]);
                let around: Vec<usize> = around.collect();
                parents.push(around.iter().rev().take(*depth).next_back().copied());
            }
            let outermost: Vec<usize> = (0..count).filter(|&state| parents[state].is_none()).collect();
            let initial = outermost[initial.index(outermost.len())];
            let argument = |k: usize| Argument { name: format!("a{k}"), type_name: "vector of length".to_owned() };
            let numbered = |(k, (name, _)): (usize, (String, usize))| {
                let is_first = parents[k].is_some() && !parents[..k].contains(&parents[k]);
                let arguments = (0..k % 4).map(argument).collect();
                State { index: k, arguments, ..state(&format!("{name}{k}"), parents[k], k == initial || is_first) }
            };
            let transition = |(from, to, text, lasting): (usize, usize, String, Option<String>)| Transition {
                number: None,
                exits: Vec::new(),
                origin: if from >= 12 { Origin::AnyState } else { Origin::State(from % count) },
                target: if to >= 12 && from % 3 == 0 {
                    Target::Exit { behaviour: "b".to_owned(), name: format!("e{from}"), values: vec![text.clone()] }
                } else if to >= 12 && from % 2 == 0 {
                    Target::Success(text.clone())
                } else if to >= 12 {
                    Target::Failure(text.clone())
                } else {
                    into(to % count, vec![text.clone(); (to % count) % 4])
                },
                guard: Guard::When { condition: text, lasting },
            };
            Chart {
                machine: "m".to_owned(),
                states: states.into_iter().enumerate().map(numbered).collect(),
                transitions: transitions.into_iter().map(transition).collect(),
                contracts: Vec::new(),
                parents,
                is_overview: false,
            }
        },
    )
}
