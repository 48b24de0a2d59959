//! Loop-invariant code motion: the computation of run invariants at the start of the run.

use vibrissa_runtime::machine::{Effect, Operands, RegisterSpan};

use super::draft::Draft;

/// Moves operations to the start of the run if their inputs never change and no other operation writes their results.
/// `operands` belong to the operations of `draft`.
pub(super) fn hoist(draft: &mut Draft, operands: &[Operands]) {
    let mut writers = vec![0_u32; draft.registers()];
    let kept = operands.iter().zip(&draft.is_kept).filter(|(_, is_kept)| **is_kept);
    for place in kept.flat_map(|(operands, _)| operands.writes) {
        writers[place.registers()].iter_mut().for_each(|count| *count += 1);
    }
    for ((op, operands), is_kept) in draft.ops.iter().zip(operands).zip(&mut draft.is_kept) {
        let are = |count: u32, places: &[RegisterSpan]| {
            places.iter().all(|place| writers[place.registers()].iter().all(|&writers| writers == count))
        };
        if *is_kept && op.effect() == Effect::Pure && are(0, &operands.reads) && are(1, &operands.writes) {
            *is_kept = false;
            draft.start.push(*op);
            // The results are invariant from now on.
            for place in operands.writes {
                writers[place.registers()].fill(0);
            }
        }
    }
}
