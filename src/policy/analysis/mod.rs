//! What a policy that compiles may still have wrong with it.
//!
//! The syntax tree says where things are written, the program what they mean. Conditions are evaluated over intervals
//! (`bounds`) in regions of all that can be felt (`region`), which are narrowed to where it may be as wanted (`narrow`) and split
//! until the question is settled or a witness is found (`search`). A witness is checked by the machine's own evaluator. Each of the
//! other files is one kind of warning.

mod arithmetic;
mod bounds;
mod cycle;
mod direction;
mod flow;
mod guards;
mod interval;
mod model;
mod names;
mod narrow;
mod overlap;
mod point;
mod reach;
mod region;
mod search;
mod shadow;
mod unknown;
mod unused;
mod walk;
mod witness;

use crate::diagnostic::Diagnostic;

use super::ast::File;
use super::load::Files;
use super::lower::Lowered;
use model::{Edge, Model};
use search::Search;

/// Warnings that are told of one policy.
const WARNING_LIMIT: usize = 50;

/// Errors that show only in the policy as a whole: cycles of transitions within one tick.
pub(super) fn errors(file: &File, lowered: &Lowered) -> Vec<Diagnostic> {
    in_order(cycle::cycles(&Model::new(file, lowered)))
}

/// What is probably not meant, in the order of the text.
pub(super) fn warnings(files: &Files, lowered: &Lowered) -> Vec<Diagnostic> {
    let model = Model::new(&files.main, lowered);
    let mut warnings = Vec::new();
    unused::unused(files, &mut warnings);
    reach::unreachable(&model, &mut warnings);
    reach::without_a_way_out(&model, &mut warnings);
    let mut search = Search::new(&model);
    transitions(&mut search, (&[], &[]), &model.always, &mut warnings);
    // For every state, its transitions that can be due.
    let mut due: Vec<Vec<Edge<'_>>> = Vec::with_capacity(model.states.len());
    for (index, state) in model.states.iter().enumerate() {
        let around = if search.is_exhausted() { Vec::new() } else { model.inward(index) };
        let outer: Vec<Edge<'_>> =
            around.into_iter().filter(|&outer| outer != index).flat_map(|outer| due[outer].iter().copied()).collect();
        search.bounds.work += outer.len();
        due.push(transitions(&mut search, (&model.always, &outer), &state.edges, &mut warnings));
    }
    in_order(warnings)
}

/// What is probably not meant in a library, in the order of the text.
pub(super) fn library_warnings(files: &Files) -> Vec<Diagnostic> {
    let mut warnings = Vec::new();
    unused::unused(files, &mut warnings);
    in_order(warnings)
}

/// Looks at the transitions of one source, and gives those that can be due; the rules that hold always and the transitions of
/// outer states are tried before them.
fn transitions<'a>(
    search: &mut Search<'_>,
    (always, outer): (&[Edge<'a>], &[Edge<'a>]),
    edges: &[Edge<'a>],
    warnings: &mut Vec<Diagnostic>,
) -> Vec<Edge<'a>> {
    let can_hold = guards::guards(search, edges, warnings);
    for index in (0..edges.len()).filter(|&index| can_hold[index]) {
        if search.is_exhausted() {
            break;
        }
        if !shadow::shadowed(search, outer, edges, &can_hold, index, warnings) {
            overlap::overlap(search, (always, outer), edges, index, warnings);
        }
    }
    edges.iter().zip(can_hold).filter(|(_, can_hold)| *can_hold).map(|(edge, _)| *edge).collect()
}

fn in_order(mut diagnostics: Vec<Diagnostic>) -> Vec<Diagnostic> {
    diagnostics.sort_by_key(|diagnostic| (diagnostic.primary.span.start, diagnostic.code));
    diagnostics.truncate(WARNING_LIMIT);
    diagnostics
}
