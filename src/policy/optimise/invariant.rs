//! What parameters and constants fix is computed once a run.

use crate::machine::{Effect, Place};

use super::draft::Draft;

/// Moves to the start of a run what follows from registers that never change, and is the only thing in its own.
pub(super) fn hoist(draft: &mut Draft) {
    let mut writers = vec![0_u32; draft.registers()];
    let kept = || draft.ops.iter().zip(&draft.is_kept).filter(|(_, is_kept)| **is_kept);
    for register in kept().flat_map(|(op, _)| op.operands().writes).flat_map(Place::registers) {
        writers[register] += 1;
    }
    for (op, is_kept) in draft.ops.iter().zip(&mut draft.is_kept).filter(|(_, is_kept)| **is_kept) {
        let operands = op.operands();
        let mut read = operands.reads.into_iter().flat_map(Place::registers);
        let written = || operands.writes.into_iter().flat_map(Place::registers);
        if op.effect() == Effect::Computes
            && read.all(|register| writers[register] == 0)
            && written().all(|register| writers[register] == 1)
        {
            *is_kept = false;
            draft.start.push(*op);
            // From now on the same for a whole run.
            written().for_each(|register| writers[register] = 0);
        }
    }
}
