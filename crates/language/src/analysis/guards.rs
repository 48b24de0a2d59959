//! Guards that never or always hold, and durations without effect.

use crate::ast;
use vibrissa_runtime::machine;
use vibrissa_text::diagnostic::Diagnostic;

use super::interval::Interval;
use super::model::Edge;
use super::region::Region;
use super::search::{Goal, Search};

/// Warns about guards whose condition never or always holds, and about durations that are not positive. Returns for
/// each transition whether it can be due.
pub(super) fn guards(search: &mut Search<'_>, edges: &[Edge<'_>], warnings: &mut Vec<Diagnostic>) -> Vec<bool> {
    edges.iter().map(|edge| guard(search, edge, warnings)).collect()
}

fn guard(search: &mut Search<'_>, edge: &Edge<'_>, warnings: &mut Vec<Diagnostic>) -> bool {
    if let Some(condition) = edge.condition() {
        if search.excludes(&[Goal::holds(condition)]) {
            warnings.push(
                Diagnostic::warning("P0508", "this guard never holds", edge.guard_span(), "never holds")
                    .hint("it is false for all possible inputs and for all values that parameters may have"),
            );
            return false;
        }
        if !is_true(edge) && search.excludes(&[Goal::fails(condition)]) {
            warnings.push(
                Diagnostic::warning("P0509", "this guard always holds", edge.guard_span(), "always holds")
                    .hint("it holds for all possible inputs; write `true` if this is intended"),
            );
        }
    }
    let time = delay(search, edge);
    if let Some(span) = time_span(edge)
        && !time.nan
        && time.high <= 0.0
    {
        let (message, hint) = match edge.guard {
            machine::Guard::After { .. } => {
                ("this time is never positive", "write `when true` for an immediate transition, or a longer time")
            }
            machine::Guard::When { .. } => ("this duration has no effect", "leave it out, or write a longer one"),
        };
        warnings.push(Diagnostic::warning("P0510", message, span, "never more than 0 s").hint(hint));
    }
    true
}

/// The time between the beginning of a transition's condition, or the entry of its state, and the transition (s).
pub(super) fn delay(search: &mut Search<'_>, edge: &Edge<'_>) -> Interval {
    let (code, register) = match edge.guard {
        machine::Guard::When { lasting: None, .. } => return Interval::point(0.0),
        machine::Guard::When { code, lasting: Some((register, _)), .. } => (code, *register),
        machine::Guard::After { code, time } => (code, *time),
    };
    let mut region = Region::whole(search.model);
    search.bounds.value(code, register, &mut region).unwrap_or(Interval::ANYTHING)
}

fn time_span(edge: &Edge<'_>) -> Option<vibrissa_text::diagnostic::Span> {
    match &edge.written.guard {
        ast::Guard::When { lasting, .. } => lasting.as_ref().map(|lasting| lasting.span),
        ast::Guard::After(time) => Some(time.span),
    }
}

/// True if the guard is the literal `true`.
fn is_true(edge: &Edge<'_>) -> bool {
    matches!(&edge.written.guard, ast::Guard::When { condition, .. } if condition.kind == ast::Kind::Bool(true))
}
