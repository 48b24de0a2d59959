//! Static analysis: warnings about policies that compile, and errors of the policy as a whole.
//!
//! The syntax tree provides spans, and the program provides semantics. Conditions are evaluated over intervals
//! (`bounds`) in regions of all inputs (`region`). Regions are narrowed by backward analysis (`narrow`) and split until
//! there is a proof or a witness (`search`). The machine's own evaluator confirms each witness. Each of the other
//! modules implements one kind of warning.
//!
//! Why: docs/decisions/compiler.md#warnings-are-proved-or-witnessed.

mod arithmetic;
mod bounds;
mod contract;
mod cycle;
mod cycle_search;
mod data_flow;
mod direction;
mod guards;
mod interval;
mod model;
mod names;
mod narrow;
mod never_taken;
mod overlap;
mod point;
mod reachability;
mod region;
mod search;
mod unknown;
mod unused;
mod witness;

use std::collections::HashMap;
use std::sync::Arc;

use crate::diagnostic::{Diagnostic, Span};
use vibrissa_runtime::machine;

use super::ast::{self, Behaviour};
use super::load::Files;
use super::lower::Lowered;
use contract::Proofs;
use model::{Edge, Model};
use search::Search;

/// The maximum number of warnings per policy.
const WARNING_LIMIT: usize = 50;

/// Errors of the policy as a whole: cycles of transitions within one tick.
pub(super) fn errors(files: &Files, lowered: &Lowered) -> Vec<Diagnostic> {
    in_order(cycle::cycles(&Model::new(files, lowered)))
}

/// Removes the contracts that are proved from a program and from its syntax tree, and returns their states and texts. A
/// machine need not watch them.
pub(super) fn take_proved(files: &mut Files, lowered: &mut Lowered) -> Vec<ProvedContract> {
    let has_any = !lowered.program.contracts.is_empty();
    if !has_any && lowered.program.states.iter().all(|state| state.contracts.is_empty()) {
        return Vec::new();
    }
    let Proofs { machine, states } = contract::prove(&Model::new(files, lowered));
    let mut proved = Vec::new();
    let mut take = |state: Option<&str>,
                    contracts: &mut Vec<machine::Contract>,
                    written: &mut Vec<ast::Contract>,
                    is_proved: &[bool]| {
        let known = contracts.iter().zip(is_proved).filter(|(_, is_proved)| **is_proved);
        let state = state.map(str::to_owned);
        proved.extend(
            known.map(|(contract, _)| ProvedContract { state: state.clone(), text: contract.text.to_string() }),
        );
        let (mut kept, mut kept_written) = (is_proved.iter(), is_proved.iter());
        contracts.retain(|_| kept.next() == Some(&false));
        written.retain(|_| kept_written.next() == Some(&false));
    };
    take(None, &mut lowered.program.contracts, &mut files.main.contracts, &machine);
    let of_states = lowered.program.states.iter_mut().zip(&mut files.machine.states).zip(&states);
    for ((state, written), is_proved) in of_states {
        if is_proved.contains(&true) {
            take(Some(&state.name), &mut state.contracts, Arc::make_mut(&mut written.contracts), is_proved);
        }
    }
    proved
}

/// A contract that no run can violate.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ProvedContract {
    /// Name of its state. `None` for a contract of the whole machine.
    pub state: Option<String>,
    /// Its text on one line.
    pub text: String,
}

/// Warnings, in the order of the text.
pub(super) fn warnings(files: &Files, lowered: &Lowered) -> Vec<Diagnostic> {
    let model = Model::new(files, lowered);
    let mut warnings = Vec::new();
    unused::unused(files, &mut warnings);
    reachability::unreachable(&model, &mut warnings);
    reachability::without_exit(&model, &mut warnings);
    let mut search = Search::new(&model);
    transitions(&mut search, (&[], &[]), &model.always, &mut warnings);
    contract::violated(&mut search, &model.program.contracts, &files.main.contracts, &mut warnings);
    // For every state, its transitions that can be due.
    let mut due: Vec<Vec<Edge<'_>>> = Vec::with_capacity(model.states.len());
    for (index, state) in model.states.iter().enumerate() {
        let around = if search.is_exhausted() { Vec::new() } else { model.inward(index) };
        let outer: Vec<Edge<'_>> =
            around.into_iter().filter(|&outer| outer != index).flat_map(|outer| due[outer].iter().copied()).collect();
        search.bounds.work += outer.len();
        due.push(transitions(&mut search, (&model.always, &outer), &state.edges, &mut warnings));
        let written = &files.machine.states[index].contracts;
        contract::violated(&mut search, &model.program.states[index].contracts, written, &mut warnings);
    }
    in_order(in_all_copies(files, &warnings))
}

/// The warnings about the text of the policy itself. One about a behaviour counts only if it holds for every copy.
fn in_all_copies(files: &Files, warnings: &[Diagnostic]) -> Vec<Diagnostic> {
    let own_end = files.libraries.iter().map(|library| library.name.span.start).min().unwrap_or(usize::MAX);
    // There may be thousands of copies, and of warnings about each.
    let mut uses: HashMap<Span, usize> = HashMap::new();
    for instance in files.machine.instances.iter().filter(|instance| instance.user.is_some()) {
        *uses.entry(instance.name.span).or_default() += 1;
    }
    let mut counts: HashMap<(&'static str, Span), usize> = HashMap::new();
    for warning in warnings {
        *counts.entry((warning.code, warning.primary.span)).or_default() += 1;
    }
    let mut kept = Vec::new();
    for warning in warnings {
        // The first of those about the same stands for all.
        let Some(count) = counts.remove(&(warning.code, warning.primary.span)) else { continue };
        let is_within =
            |behaviour: &&Behaviour| (behaviour.span.start..behaviour.span.end).contains(&warning.primary.span.start);
        let behaviour = files.main.behaviours.iter().find(is_within);
        let copies = behaviour.map_or(1, |behaviour| uses.get(&behaviour.name.span).copied().unwrap_or_default());
        let is_whole = warning.code == "P0507" || count >= copies;
        if warning.primary.span.start < own_end && is_whole {
            kept.push(warning.clone());
        }
    }
    kept
}

/// Warnings about a library, in the order of the text.
pub(super) fn library_warnings(files: &Files) -> Vec<Diagnostic> {
    let mut warnings = Vec::new();
    unused::unused(files, &mut warnings);
    in_order(warnings)
}

/// Analyses the transitions of one source. Returns those that can be due. Global transitions and those of outer states
/// precede them.
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
        if !never_taken::report_never_taken(search, outer, edges, &can_hold, index, warnings) {
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
