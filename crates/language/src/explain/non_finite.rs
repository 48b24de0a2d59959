//! The origin of a number that is not finite.

use vibrissa_runtime::machine::{Block, Op, RegisterSpan};

use super::Explained;

impl Explained {
    /// The text of the expression at which a number that is not finite arises, in the statements that a tick in `state` executes.
    /// `registers` are those after these statements. `None` if all of them are finite, or if only memory of an earlier tick is not.
    #[must_use]
    pub fn origin_of_non_finite(&self, state: usize, registers: &[f64]) -> Option<String> {
        let mut states: Vec<usize> = self.program.outward(state).collect();
        states.reverse();
        let bodies = states.iter().map(|&state| &self.program.states[state].body);
        let mut blocks = std::iter::once(&self.program.body).chain(bodies);
        blocks.find_map(|block| self.origin_in(block, registers))
    }

    fn origin_in(&self, block: &Block, registers: &[f64]) -> Option<String> {
        let value = |index: usize| registers.get(index).copied().unwrap_or_default();
        let is_finite = |span: &RegisterSpan| span.registers().all(|index| value(index).is_finite());
        let mut next = block.start;
        while next < block.end {
            let op = *self.program.code.get(next as usize)?;
            next += 1;
            match op {
                Op::Jump { target } => next = target,
                Op::JumpUnless { a, target } if value(usize::from(a)) <= 0.5 => next = target,
                _ => {
                    let operands = op.operands();
                    let arises = operands.all_reads().iter().all(is_finite) && !operands.writes.iter().all(is_finite);
                    if let (true, Some(origin)) = (arises, self.origins.get(operands.writes[0].first)) {
                        return Some(self.source.on_one_line(origin.span));
                    }
                }
            }
        }
        None
    }
}
