//! Construction of conditions from the code of guards.

use std::collections::HashMap;

use vibrissa_runtime::machine::{self, Op, Program, Register};

use crate::lower::{Origin, Origins};
use vibrissa_text::diagnostic::Source;

use super::condition::{Comparison, Condition, Leaf};

/// The maximum number of parts of a condition that are divided. Arguments share their values, so that a condition may have more parts
/// than operations.
const PART_LIMIT: usize = 1000;

/// Builds the conditions of a program that is not optimised: every value has a register of its own.
pub(super) struct Builder<'p> {
    pub(super) program: &'p Program,
    pub(super) source: &'p Source,
    pub(super) origins: &'p Origins,
}

impl Builder<'_> {
    /// The condition of a guard. `None` for `after`.
    pub(super) fn condition(&self, guard: &machine::Guard) -> Option<Condition> {
        let machine::Guard::When { code, truth, .. } = guard else { return None };
        Some(self.condition_in(code, *truth))
    }

    /// The condition that code computes into a register.
    pub(super) fn condition_in(&self, code: &machine::Block, truth: Register) -> Condition {
        let code = self.program.code.get(code.start as usize..code.end as usize).unwrap_or_default();
        let results = code.iter().filter_map(|&op| Some((op.bool_result()?, op))).collect();
        self.node(&results, truth, None, Negation::default(), &mut { PART_LIMIT })
    }

    /// The condition in a register. `outer` is the bool that it is a part of. `left` is the number of parts that may still be divided.
    fn node(
        &self,
        results: &HashMap<Register, Op>,
        register: Register,
        outer: Option<Origin>,
        negation: Negation,
        left: &mut usize,
    ) -> Condition {
        let may_divide = *left > 0;
        *left = left.saturating_sub(1);
        let origin = self.origins.get(register).or(outer);
        let dimension = origin.and_then(|origin| origin.compared);
        let kind = match results.get(&register) {
            Some(&Op::And { a, b, .. }) if may_divide => {
                return joined([a, b].map(|part| self.node(results, part, origin, negation, left)), !negation.of_value);
            }
            Some(&Op::Or { a, b, .. }) if may_divide => {
                return joined([a, b].map(|part| self.node(results, part, origin, negation, left)), negation.of_value);
            }
            Some(&Op::Not { a, .. }) if may_divide => {
                // The text of `a != b` contains its negation.
                let of_text = if self.origins.get(a).is_some() { !negation.of_text } else { negation.of_text };
                return self.node(results, a, origin, Negation { of_value: !negation.of_value, of_text }, left);
            }
            Some(&(Op::Less { a, b, .. } | Op::LessOrEqual { a, b, .. })) => {
                dimension.map(|dimension| (a, b, false, dimension))
            }
            Some(&Op::Equal { a, b, .. }) => dimension.map(|dimension| (a, b, true, dimension)),
            _ => None,
        };
        let compared =
            kind.map(|(left, right, is_equality, dimension)| Comparison { left, right, is_equality, dimension });
        let text = origin.map_or_else(String::new, |origin| self.source.on_one_line(origin.span));
        let text = if negation.of_text { format!("not {text}") } else { text };
        Condition::Leaf(Leaf { text, truth: register, is_negated: negation.of_value, compared })
    }
}

/// The negations around a part of a condition.
#[derive(Debug, Clone, Copy, Default)]
struct Negation {
    /// True if the part has to be false.
    of_value: bool,
    /// True if the text of the part does not say so.
    of_text: bool,
}

/// Joins two conditions. `a and b and c` becomes one list.
fn joined(parts: [Condition; 2], by_and: bool) -> Condition {
    let flat = parts.into_iter().flat_map(|part| match part {
        Condition::All(inner) if by_and => inner,
        Condition::Any(inner) if !by_and => inner,
        part => vec![part],
    });
    if by_and { Condition::All(flat.collect()) } else { Condition::Any(flat.collect()) }
}
