//! What nothing reads is not computed.

use crate::machine::{Effect, Op, Place};

use super::draft::Draft;

/// Strikes out what nothing reads. Gives how often each register is read by what is left.
pub(super) fn remove(draft: &mut Draft) -> Vec<u32> {
    let mut reads = vec![0_u32; draft.registers()];
    for register in draft.read_by_guards() {
        reads[usize::from(register)] += 1;
    }
    let operands = |op: &Op| {
        let operands = op.operands();
        operands.reads.into_iter().flat_map(Place::registers).chain(operands.whisker.map(usize::from))
    };
    for register in draft.ops.iter().flat_map(operands) {
        reads[register] += 1;
    }
    // From behind, so that what only such an operation reads is found too.
    for (op, is_kept) in draft.ops.iter().zip(&mut draft.is_kept).rev() {
        let mut written = op.operands().writes.into_iter().flat_map(Place::registers);
        if op.effect() != Effect::Acts && written.all(|register| reads[register] == 0) {
            *is_kept = false;
            operands(op).for_each(|register| reads[register] -= 1);
        }
    }
    reads
}
