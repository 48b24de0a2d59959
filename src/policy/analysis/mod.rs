//! What a policy that compiles may still have wrong with it.
//!
//! The syntax tree says where things are written, the program what they mean. Conditions are evaluated over intervals
//! (`bounds`) in regions of all that can be felt (`region`), which are narrowed to where it may be as wanted (`narrow`) and split until the question is settled or a witness is
//! found (`search`). A witness is checked by the machine's own evaluator. Each of the other files is one kind of warning.

mod bounds;
mod cycle;
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
    let sources = std::iter::once((&[][..], model.always.as_slice()));
    let sources = sources.chain(model.states.iter().map(|state| (model.always.as_slice(), state.edges.as_slice())));
    for (above, edges) in sources {
        transitions(&mut search, above, edges, &mut warnings);
    }
    in_order(warnings)
}

/// What is probably not meant in a library, in the order of the text.
pub(super) fn library_warnings(files: &Files) -> Vec<Diagnostic> {
    let mut warnings = Vec::new();
    unused::unused(files, &mut warnings);
    in_order(warnings)
}

/// Looks at the transitions of one source; those `above` are tried before them.
fn transitions(search: &mut Search<'_>, above: &[Edge<'_>], edges: &[Edge<'_>], warnings: &mut Vec<Diagnostic>) {
    let can_hold = guards::guards(search, edges, warnings);
    for index in (0..edges.len()).filter(|&index| can_hold[index]) {
        if search.is_exhausted() {
            return;
        }
        if !shadow::shadowed(search, edges, &can_hold, index, warnings) {
            overlap::overlap(search, above, edges, index, warnings);
        }
    }
}

fn in_order(mut diagnostics: Vec<Diagnostic>) -> Vec<Diagnostic> {
    diagnostics.sort_by_key(|diagnostic| (diagnostic.primary.span.start, diagnostic.code));
    diagnostics.truncate(WARNING_LIMIT);
    diagnostics
}
