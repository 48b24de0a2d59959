//! Transitions that are never taken, because others always precede them.

use vibrissa_runtime::machine::{Guard, Program, Register, TIME_SLACK};
use vibrissa_text::diagnostic::Diagnostic;

use super::guards::delay;
use super::interval::Interval;
use super::model::{Edge, Model};
use super::search::{Goal, Search};

/// Warns about a transition that is never taken because others of its state, or of the `outer` ones, always precede it.
/// Returns true if it warned. `outer` are the transitions of outer states that can be due.
pub(super) fn report_never_taken(
    search: &mut Search<'_>,
    outer: &[Edge<'_>],
    edges: &[Edge<'_>],
    can_hold: &[bool],
    index: usize,
    warnings: &mut Vec<Diagnostic>,
) -> bool {
    let edge = &edges[index];
    let time = delay(search, edge);
    let mut immediate = Vec::new();
    search.bounds.work += outer.len();
    // A transition with an already active target pre-empts later ones of the same state, but not those of inner states.
    let of_sources = outer.chunk_by(|one, next| one.from == next.from);
    let outer = of_sources
        .flat_map(|edges| edges.iter().take_while(|before| comes_first(search.model.program, before, edge)))
        .map(|before| (0, before));
    let outer: Vec<(usize, &Edge<'_>)> = outer.collect();
    // A later transition may be due sooner. But not every one leaves its state or permits the following ones.
    let program = search.model.program;
    let stays = edges.iter().enumerate().position(|(other, before)| other != index && !leaves(program, before));
    let counts = |other: usize| other < index || stays.is_none_or(|stays| other < stays);
    let own = edges.iter().enumerate().filter(|&(other, _)| other != index && can_hold[other] && counts(other));
    let own = own.filter(|(_, before)| comes_first(program, before, edge)).map(|(other, before)| (other + 1, before));
    let index = index + 1;
    for (other, before) in outer.into_iter().chain(own) {
        if before.is_immediate() && (other < index || time.low > TIME_SLACK) {
            immediate.push(before);
        }
        if comes_before(search, (other, before), (index, edge), time) {
            warnings.push(never_taken(edge).note(before.span(), "is taken before it whenever both are due"));
            return true;
        }
    }
    // No single transition precedes it. Several immediate ones may do so together.
    let goals = edge.condition().map(Goal::holds).into_iter();
    let goals: Vec<Goal<'_>> =
        goals.chain(immediate.iter().filter_map(|edge| edge.condition()).map(Goal::fails)).collect();
    if immediate.len() < 2 || !search.excludes(&goals) {
        return false;
    }
    let notes = immediate.iter().map(|before| before.span());
    warnings
        .push(notes.fold(never_taken(edge), |warning, span| warning.note(span, "this or another is taken before it")));
    true
}

/// True if a transition, of the same state or of an outer one, is taken before another whenever both are due.
///
/// A transition with an already active target is not taken again. One of an outer state then does not precede, and one
/// of the same state does not precede an end of the run.
pub(super) fn comes_first(program: &Program, before: &Edge<'_>, edge: &Edge<'_>) -> bool {
    if edge.leads_to().is_none() && before.from == edge.from && !leaves(program, before) {
        return false;
    }
    let (Some(target), Some(state)) = (before.leads_to(), edge.from) else { return true };
    let is_related = program.contains(target, state) || program.contains(state, target);
    before.from == edge.from || !is_related || leaves(program, before)
}

/// True if a transition leaves its state, so that the durations of the others begin again.
pub(super) fn leaves(program: &Program, edge: &Edge<'_>) -> bool {
    edge.leads_to().is_none_or(|target| !program.is_target_active(edge.from, target, target))
}

/// True if one transition is always due no later than another, and is then taken instead of it.
fn comes_before(
    search: &mut Search<'_>,
    (index, before): (usize, &Edge<'_>),
    (other, edge): (usize, &Edge<'_>),
    time: Interval,
) -> bool {
    let before_time = delay(search, before);
    let same =
        register_of_time(search.model, before).is_some_and(|time| register_of_time(search.model, edge) == Some(time));
    let is_sooner = before_time.high + TIME_SLACK < time.low;
    let is_as_soon = index < other && (same || before_time.high <= time.low);
    if before_time.nan || !(is_sooner || is_as_soon) {
        return false;
    }
    if matches!(before.guard, Guard::After { .. }) {
        // Both durations begin with their states, and that of an outer state begins first. A condition cannot begin
        // before its state.
        return !edge.is_immediate();
    }
    let goals: Vec<Goal<'_>> =
        edge.condition().map(Goal::holds).into_iter().chain(before.condition().map(Goal::fails)).collect();
    search.excludes(&goals)
}

/// The register of a transition's duration, if its value does not change while the state is active.
fn register_of_time(model: &Model<'_>, edge: &Edge<'_>) -> Option<Register> {
    let register = match edge.guard {
        Guard::When { lasting, .. } => lasting.as_ref()?.0,
        Guard::After { time, .. } => *time,
    };
    model.is_steady(register).then_some(register)
}

fn never_taken(edge: &Edge<'_>) -> Diagnostic {
    Diagnostic::warning("P0511", "this transition is never taken", edge.span(), "never taken")
        .hint("transitions are tried in order: move this one up, or restrict the guard of the other")
}
