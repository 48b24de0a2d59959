//! Guards that can hold at the same time and have different targets.

use crate::ast::{Expression, Kind};
use vibrissa_runtime::machine::Program;
use vibrissa_text::diagnostic::Diagnostic;

use super::model::Edge;
use super::never_taken::comes_first;
use super::search::{Goal, Search};

/// Warns if a transition's guard can hold together with that of a preceding one, so that only their order decides.
///
/// Global transitions and those of outer states precede all of `edges`. Those of outer states monitor their inner
/// states on purpose.
///
/// There is no warning if the first transition ends the run, because limits are deliberately checked first. There
/// is none if both have the same target, or if the second guard holds wherever the first does. Points at which a third
/// transition precedes both do not count.
pub(super) fn overlap(
    search: &mut Search<'_>,
    (always, outer): (&[Edge<'_>], &[Edge<'_>]),
    edges: &[Edge<'_>],
    index: usize,
    warnings: &mut Vec<Diagnostic>,
) {
    let edge = &edges[index];
    let program = search.model.program;
    let Some(second) = edge.condition().filter(|_| edge.is_immediate()) else { return };
    let earlier: Vec<&Edge<'_>> =
        always.iter().chain(outer).chain(&edges[..index]).filter(|edge| edge.is_immediate()).collect();
    for (at, before) in earlier.iter().enumerate() {
        let Some(first) = before.condition() else { continue };
        if before.leads_to().is_none() || leads_to_the_same(before, edge) || is_watch(program, before, edge) {
            continue;
        }
        let others =
            earlier.iter().enumerate().filter(|&(other, _)| other != at).filter_map(|(_, edge)| edge.condition());
        let goals: Vec<Goal<'_>> =
            [Goal::holds(first), Goal::holds(second)].into_iter().chain(others.map(Goal::fails)).collect();
        let Some(point) = search.witness(&goals, None) else { continue };
        if search.witness(&[Goal::holds(first), Goal::fails(second)], None).is_none() {
            continue;
        }
        let witness = search.describe(&goals, point);
        warnings.push(
            Diagnostic::warning("P0512", "two guards can hold at once", edge.span(), "not taken in this case")
                .note(before.span(), "this comes first, and is taken")
                .hint(format!("both hold at {witness}"))
                .hint("if this order is intended, make it explicit: `when \u{2026} and not \u{2026}`; otherwise change the order"),
        );
        // One witness per transition suffices.
        return;
    }
}

/// True if the first of two transitions belongs to an outer state of the second's, or does not always precede it
/// because its target may already be active.
fn is_watch(program: &Program, before: &Edge<'_>, edge: &Edge<'_>) -> bool {
    before.from != edge.from && (before.from.is_some() || !comes_first(program, before, edge))
}

/// True if two values are the same, as far as names show.
fn is_same((a, b): (&Expression, &Expression)) -> bool {
    match (&a.kind, &b.kind) {
        (Kind::Root { name: a, values: None }, Kind::Root { name: b, values: None }) => a.text == b.text,
        (Kind::Named { name, value }, Kind::Named { name: other, value: b }) => {
            name.text == other.text && is_same((value, b))
        }
        _ => false,
    }
}

/// True if two transitions have the same target with the same values, as far as names show, or both end the run.
fn leads_to_the_same(a: &Edge<'_>, b: &Edge<'_>) -> bool {
    let exit = |edge: &Edge<'_>| {
        let target = &edge.written.target;
        target.is_exit.then(|| target.name.text.clone())
    };
    let has_same_values = a.values().count() == b.values().count() && a.values().zip(b.values()).all(is_same);
    a.leads_to() == b.leads_to() && exit(a) == exit(b) && has_same_values
}
