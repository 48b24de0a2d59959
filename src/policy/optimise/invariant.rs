//! What parameters and constants fix is computed once a run.

use vibrissa_runtime::machine::{Effect, Operands, Place};

use super::draft::Draft;

/// Moves to the start of a run what follows from registers that never change, and is the only thing in its own. `operands` are
/// those of every operation.
pub(super) fn hoist(draft: &mut Draft, operands: &[Operands]) {
    let mut writers = vec![0_u32; draft.registers()];
    let kept = operands.iter().zip(&draft.is_kept).filter(|(_, is_kept)| **is_kept);
    for place in kept.flat_map(|(operands, _)| operands.writes) {
        writers[place.registers()].iter_mut().for_each(|count| *count += 1);
    }
    for ((op, operands), is_kept) in draft.ops.iter().zip(operands).zip(&mut draft.is_kept) {
        let are = |count: u32, places: &[Place]| {
            places.iter().all(|place| writers[place.registers()].iter().all(|&writers| writers == count))
        };
        if *is_kept && op.effect() == Effect::Computes && are(0, &operands.reads) && are(1, &operands.writes) {
            *is_kept = false;
            draft.start.push(*op);
            // From now on the same for a whole run.
            for place in operands.writes {
                writers[place.registers()].fill(0);
            }
        }
    }
}
