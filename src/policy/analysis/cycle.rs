//! Cycles of transitions within one tick.

use std::sync::Arc;

use crate::diagnostic::Diagnostic;
use crate::machine::{CHAIN_LIMIT, Cause, Failure, Machine, WhiskerScalar};

use super::model::{Edge, Model};
use super::point::Point;
use super::reach::reachable;
use super::search::{Goal, Search};
use super::unknown::{Domain, Unknown};

/// Steps of the walk that looks for cycles among the states.
const STEP_LIMIT: usize = 10_000;
/// Cycles that are looked at.
const CYCLE_LIMIT: usize = 100;
/// Ways to go along a cycle that are looked at.
const WAY_LIMIT: usize = 16;

/// Reports cycles of transitions that a tick cannot end, each with values at which a machine indeed fails in one.
pub(super) fn cycles(model: &Model<'_>) -> Vec<Diagnostic> {
    let mut faults = Vec::new();
    let found = walk(model);
    if found.is_empty() {
        return faults;
    }
    let program = Arc::new(model.program.clone());
    let mut search = Search::new(model);
    let mut told = vec![false; model.states.len()];
    for path in &found {
        // A cycle of states that were told would say little more.
        if path.iter().all(|&(state, _)| told[state]) {
            continue;
        }
        let start = path[0].0;
        let fails = |point: &Point, registers: Vec<f64>| {
            is_felt_freely(model, point) && {
                let mut machine = Machine::entering(Arc::clone(&program), start, registers);
                let left = machine.tick(&mut point.clone()).failsafe;
                // A failsafe is for what nobody foresaw, and so excuses no cycle.
                matches!(machine.failure(), Some(Failure::Chain { .. }))
                    || left.is_some_and(|failsafe| failsafe.cause == Cause::Chain)
            }
        };
        for goals in goals(model, path) {
            if let Some(point) = search.witness(&goals, Some(&fails)) {
                let witness = search.describe_such(&goals, point, Some(&fails));
                for &(state, _) in path {
                    told[state] = true;
                }
                faults.push(fault(model, path, &witness));
                break;
            }
        }
    }
    faults
}

/// What it takes to go along a path, in every way that there is: each of its guards holds, and none that is tried before it
/// keeps it from being taken. In an outer state all of those fail, or the first that does not has led where it leads.
fn goals<'a>(model: &Model<'a>, path: &[(usize, &Edge<'a>)]) -> Vec<Vec<Goal<'a>>> {
    let mut all = vec![path.iter().filter_map(|(_, edge)| edge.condition()).map(Goal::holds).collect::<Vec<_>>()];
    for &(state, edge) in path {
        let before = model.tried_before(edge, state);
        for of_source in before.chunk_by(|one, next| one.from == next.from) {
            let (mut ways, mut failing) = (Vec::new(), Vec::new());
            for before in of_source.iter().filter(|before| before.is_immediate()) {
                let has_led = before.leads_to().is_some() && model.leads_to_one(before, state).is_none();
                let Some(condition) = before.condition() else { continue };
                if before.from != edge.from && has_led {
                    ways.push([failing.clone(), vec![Goal::holds(condition)]].concat());
                }
                failing.push(Goal::fails(condition));
            }
            ways.insert(0, failing);
            let longer =
                all.iter().flat_map(|goals| ways.iter().map(|way| [goals.as_slice(), way.as_slice()].concat()));
            all = longer.take(WAY_LIMIT).collect();
        }
    }
    all
}

fn fault(model: &Model<'_>, path: &[(usize, &Edge<'_>)], witness: &str) -> Diagnostic {
    let name = |state: usize| model.states[state].name.text.as_str();
    let (start, first) = path[0];
    let way: Vec<String> = path.iter().map(|&(state, _)| format!("`{}`", name(state))).collect();
    let message = format!("one tick can go round from {} to `{}` without end", way.join(" to "), name(start));
    let fault = Diagnostic::error("P0405", message, first.span(), format!("leaves `{}`", name(start)));
    path[1..]
        .iter()
        .fold(fault, |fault, &(state, edge)| fault.note(edge.span(), format!("leaves `{}`", name(state))))
        .hint(format!("all guards hold at {witness}"))
        .hint("let the guards exclude each other, or give one a duration: `when \u{2026} for 100 ms`")
}

/// Cycles of transitions that wait for nothing, among innermost states that can be reached, the shortest first.
fn walk<'a>(model: &'a Model<'_>) -> Vec<Vec<(usize, &'a Edge<'a>)>> {
    let reached = reachable(model);
    let mut found = Vec::new();
    let mut steps = 0;
    for start in (0..model.states.len()).filter(|&state| reached[state] && model.is_innermost(state)) {
        // Paths that are yet to be gone on: where they have come to, and how.
        let mut open: Vec<(usize, Vec<(usize, &Edge<'_>)>)> = vec![(start, Vec::new())];
        while let Some((state, path)) = open.pop() {
            let edges = model.active_edges(state).into_iter().filter(|edge| edge.is_immediate());
            for edge in edges {
                steps += 1;
                for target in model.leads_on(edge, state) {
                    steps += 1;
                    let mut path = path.clone();
                    path.push((state, edge));
                    let is_new = path.len() < CHAIN_LIMIT && path.iter().all(|&(passed, _)| passed != target);
                    if target == start {
                        found.push(path);
                    // Each cycle begins at the first of its states, and passes none twice.
                    } else if target > start && is_new {
                        open.push((target, path));
                    }
                }
                if steps > STEP_LIMIT || found.len() >= CYCLE_LIMIT {
                    return sorted(found);
                }
            }
        }
    }
    sorted(found)
}

fn sorted<T>(mut paths: Vec<Vec<T>>) -> Vec<Vec<T>> {
    paths.sort_by_key(Vec::len);
    paths
}

/// Whether a point is one that can be felt for sure: its values do not depend on one another in ways that only the rig
/// knows, such as where tips are.
fn is_felt_freely(model: &Model<'_>, point: &Point) -> bool {
    point.values().into_iter().all(|(unknown, _)| match unknown {
        Unknown::Register(register) => {
            usize::from(register) < model.program.parameters.len()
                || matches!(model.domain(register), None | Some(Domain::Values(_)))
        }
        Unknown::Whisker(_, quantity) => quantity == WhiskerScalar::ContourCurvature,
        Unknown::WhiskerVector(..) | Unknown::Away(_) => false,
        Unknown::Time
        | Unknown::Body(_)
        | Unknown::BodyPosition(_)
        | Unknown::Contact(_)
        | Unknown::Deflection(_)
        | Unknown::Ready(_)
        | Unknown::Travel(_) => true,
    })
}
