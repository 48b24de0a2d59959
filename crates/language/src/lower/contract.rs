//! Contracts: code that tells whether they are violated, and the margin.

use std::collections::HashMap;
use std::sync::Arc;

use crate::ast::{Contract, ContractKind};
use crate::types::Type;
use vibrissa_runtime::machine::{self, CONTRACT_LIMIT, Moment, Op, Register};
use vibrissa_runtime::units::Dimension;
use vibrissa_text::diagnostic::Diagnostic;

use super::Compiler;
use super::scope::Scope;

/// The maximum nesting depth of a condition with a margin, so that recursion cannot exhaust the stack.
const MARGIN_DEPTH_LIMIT: usize = 1000;

impl<'f> Compiler<'f> {
    /// Lowers the contracts of a state or of the machine.
    pub(super) fn contracts(&mut self, scope: &Scope<'f>, contracts: &'f [Contract]) -> Vec<machine::Contract> {
        contracts.iter().filter_map(|contract| self.contract(scope, contract)).collect()
    }

    fn contract(&mut self, scope: &Scope<'f>, contract: &'f Contract) -> Option<machine::Contract> {
        self.contract_count += 1;
        if self.contract_count == CONTRACT_LIMIT + 1 {
            let label = format!("exceeds the limit of {CONTRACT_LIMIT} contracts here");
            let diagnostic = Diagnostic::error("P0402", "the compiled policy is too large", contract.span, label);
            self.report(diagnostic.hint("every state that uses a behaviour has its contracts; use fewer"));
        }
        let start = self.code.here();
        let condition = self.expect(scope, &contract.condition, Type::Bool);
        let lasting = match &contract.time {
            None => Some(None),
            Some(time) => self.expect(scope, time, Type::TIME).map(|time| Some(time.register)),
        };
        let (condition, lasting) = (condition?.register, lasting?);
        let is_negated = contract.kind != ContractKind::Never;
        let violated = if is_negated {
            let violated = self.code.allocate(1);
            self.code.push(Op::Not { to: violated, a: condition });
            violated
        } else {
            condition
        };
        let margin = self.margin(start, violated);
        Some(machine::Contract {
            moment: if contract.kind == ContractKind::Assume { Moment::Entry } else { Moment::Tick },
            // Descriptions are added later, from the source.
            text: Arc::from(""),
            code: self.code.since(start),
            violated,
            lasting,
            margin,
        })
    }

    /// Emits the code of the margin of a bool that the code from `start` on computes: the distance of the compared numbers
    /// from the values for which it is true. `None` if the comparisons have different dimensions, or if bools are part
    /// of it.
    fn margin(&mut self, start: u32, violated: Register) -> Option<(Register, Dimension)> {
        // Beyond the limit, registers are no longer distinct.
        if self.code.full {
            return None;
        }
        let code = self.code.ops.get(start as usize..)?;
        let results: HashMap<Register, Op> = code.iter().filter_map(|&op| Some((op.bool_result()?, op))).collect();
        let mark = self.code.mark();
        let margin = self.distance(&results, violated, true, 0);
        if margin.is_none() {
            self.code.rewind(mark);
        }
        margin
    }

    /// Emits the distance of the compared numbers from a change of a bool. It is positive if the bool is true, or false for
    /// `is_negated`.
    fn distance(
        &mut self,
        results: &HashMap<Register, Op>,
        register: Register,
        is_negated: bool,
        depth: usize,
    ) -> Option<(Register, Dimension)> {
        // Arguments share their values, so that a condition may have more parts than operations.
        self.work += 1;
        if self.is_exhausted() || depth > MARGIN_DEPTH_LIMIT {
            return None;
        }
        let dimension = self.code.origins.get(register).and_then(|origin| origin.compared);
        let to = self.code.allocate(1);
        let (op, dimension) = match (*results.get(&register)?, dimension) {
            (Op::Not { a, .. }, _) => return self.distance(results, a, !is_negated, depth + 1),
            (Op::Less { a, b, .. } | Op::LessOrEqual { a, b, .. }, Some(dimension)) => {
                let (a, b) = if is_negated { (a, b) } else { (b, a) };
                (Op::Subtract { to, a, b }, dimension)
            }
            (op @ (Op::And { a, b, .. } | Op::Or { a, b, .. }), _) => {
                let first = self.distance(results, a, is_negated, depth + 1)?;
                let second = self.distance(results, b, is_negated, depth + 1)?;
                if first.1 != second.1 {
                    return None;
                }
                let (a, b) = (first.0, second.0);
                let is_smaller = matches!(op, Op::And { .. }) != is_negated;
                (if is_smaller { Op::Minimum { to, a, b } } else { Op::Maximum { to, a, b } }, first.1)
            }
            _ => return None,
        };
        self.code.push(op);
        Some((to, dimension))
    }
}
