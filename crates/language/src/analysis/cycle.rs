//! Cycles of transitions within one tick.

use std::sync::Arc;

use vibrissa_runtime::machine::{Cause, Failure, Machine, WhiskerScalar};
use vibrissa_text::diagnostic::Diagnostic;

use super::cycle_search::{Step, goals, immediate_cycles};
use super::model::Model;
use super::point::Point;
use super::search::{Goal, Search};
use super::unknown::{Domain, Unknown};

/// Reports cycles of transitions that exceed the microstep limit, each with a witness confirmed by the machine.
pub(super) fn cycles(model: &Model<'_>) -> Vec<Diagnostic> {
    let mut faults = Vec::new();
    let found = immediate_cycles(model);
    if found.is_empty() {
        return faults;
    }
    let program = Arc::new(model.program.clone());
    let mut search = Search::new(model);
    let mut reported = vec![false; model.states.len()];
    for path in &found {
        // A cycle of states that were already reported adds little.
        if path.iter().all(|&(state, _)| reported[state]) {
            continue;
        }
        let start = path[0].0;
        let fails = |point: &Point, registers: Vec<f64>| {
            has_independent_inputs(model, point) && {
                let mut machine = Machine::entering(Arc::clone(&program), start, registers);
                let left = machine.tick(&mut point.clone()).fallback;
                // A failsafe is for what nobody foresaw, and so excuses no cycle.
                matches!(machine.failure(), Some(Failure::MicrostepLimit { .. }))
                    || left.is_some_and(|failsafe| failsafe.cause == Cause::MicrostepLimit)
            }
        };
        let goals: Vec<Goal<'_>> = path.iter().flat_map(|&step| goals(model, step)).collect();
        if let Some(point) = search.witness(&goals, Some(&fails)) {
            let witness = search.describe_such(&goals, point, Some(&fails));
            for &(state, _) in path {
                reported[state] = true;
            }
            faults.push(fault(model, path, &witness));
        }
    }
    faults
}

fn fault(model: &Model<'_>, path: &[Step<'_>], witness: &str) -> Diagnostic {
    let name = |state: usize| model.states[state].name.text.as_str();
    let (start, first) = path[0];
    let names: Vec<String> = path.iter().map(|&(state, _)| format!("`{}`", name(state))).collect();
    let message = format!("one tick can cycle endlessly from {} to `{}`", names.join(" to "), name(start));
    let fault = Diagnostic::error("P0405", message, first.span(), format!("leaves `{}`", name(start)));
    path[1..]
        .iter()
        .fold(fault, |fault, &(state, edge)| fault.note(edge.span(), format!("leaves `{}`", name(state))))
        .hint(format!("all guards hold at {witness}"))
        .hint("let the guards exclude each other, or give one a duration: `when \u{2026} for 100 ms`")
}

/// True if the inputs of a point can be chosen independently. Other inputs, such as positions of tips, depend on each
/// other through the rig.
fn has_independent_inputs(model: &Model<'_>, point: &Point) -> bool {
    point.values().into_iter().all(|(unknown, _)| match unknown {
        Unknown::Register(register) => {
            usize::from(register) < model.program.parameters.len()
                || matches!(model.domain(register), None | Some(Domain::Values(_)))
        }
        Unknown::Whisker(_, quantity) => quantity == WhiskerScalar::ContourCurvature,
        Unknown::WhiskerVector(..) | Unknown::Normal(_) => false,
        Unknown::Time
        | Unknown::Body(_)
        | Unknown::BodyPosition(_)
        | Unknown::Contact(_)
        | Unknown::Deflection(_)
        | Unknown::Contour(_)
        | Unknown::Tangent(_) => true,
    })
}
