//! Proofs of contracts, and contracts that are always violated.

use crate::ast;
use vibrissa_runtime::machine::{Contract, Moment};
use vibrissa_text::diagnostic::Diagnostic;

use super::model::{Condition, Edge, Model};
use super::never_taken::leaves;
use super::search::{Goal, Search};

/// For every contract of the machine and of each state, true if it is proved: no run can violate it.
pub(super) struct Proofs {
    pub(super) machine: Vec<bool>,
    pub(super) states: Vec<Vec<bool>>,
}

/// Tries to prove every contract.
pub(super) fn prove(model: &Model<'_>) -> Proofs {
    let mut search = Search::new(model);
    let machine = prove_all(&mut search, &model.program.contracts, &[]);
    let states = model.program.states.iter().enumerate().map(|(index, state)| {
        if state.contracts.is_empty() {
            return Vec::new();
        }
        let around = model.inward(index).into_iter();
        let before: Vec<&Edge<'_>> = around.flat_map(|state| not_due(model, &model.states[state].edges)).collect();
        prove_all(&mut search, &state.contracts, &before)
    });
    Proofs { machine, states: states.collect() }
}

/// The transitions of a state that are not due after the transitions of a tick, when contracts are evaluated. A transition
/// whose target may be active already is not taken, and neither are those behind it, except ends of the run. Global
/// transitions are tried only at the beginning of a tick.
fn not_due<'e, 'a>(model: &Model<'_>, edges: &'e [Edge<'a>]) -> Vec<&'e Edge<'a>> {
    let mut is_open = true;
    let mut known = Vec::new();
    for edge in edges {
        is_open &= leaves(model.program, edge);
        if edge.is_immediate() && (is_open || edge.leads_to().is_none()) {
            known.push(edge);
        }
    }
    known
}

fn prove_all(search: &mut Search<'_>, contracts: &[Contract], before: &[&Edge<'_>]) -> Vec<bool> {
    contracts.iter().map(|contract| prove_one(search, contract, before)).collect()
}

fn prove_one(search: &mut Search<'_>, contract: &Contract, before: &[&Edge<'_>]) -> bool {
    if search.is_exhausted() {
        return false;
    }
    let violation = Goal::holds(Condition { code: &contract.code, truth: contract.violated });
    if search.excludes(std::slice::from_ref(&violation)) {
        return true;
    }
    if contract.moment == Moment::Entry {
        return false;
    }
    let mut goals: Vec<Goal<'_>> = before.iter().filter_map(|edge| edge.condition()).map(Goal::fails).collect();
    if goals.is_empty() {
        return false;
    }
    goals.push(violation);
    search.excludes(&goals)
}

/// Warns about contracts that every run violates.
pub(super) fn violated(
    search: &mut Search<'_>,
    contracts: &[Contract],
    written: &[ast::Contract],
    warnings: &mut Vec<Diagnostic>,
) {
    for (contract, written) in contracts.iter().zip(written) {
        let kept = Goal::fails(Condition { code: &contract.code, truth: contract.violated });
        if !search.is_exhausted() && search.excludes(&[kept]) {
            let message = "this contract is always violated";
            warnings.push(
                Diagnostic::warning("P0513", message, written.span, "always violated").hint(
                    "its condition is the same for all possible inputs and for all values that parameters may have",
                ),
            );
        }
    }
}
