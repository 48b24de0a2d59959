//! Elimination of dead code.

use vibrissa_runtime::machine::{Effect, Operands};

use super::draft::Draft;

/// Removes operations whose results are never read. `operands` belong to the operations of `draft`. Returns the number
/// of remaining reads of each register.
pub(super) fn remove(draft: &mut Draft, operands: &[Operands]) -> Vec<u32> {
    let mut reads = vec![0_u32; draft.registers()];
    for register in draft.read_outside() {
        reads[usize::from(register)] += 1;
    }
    for place in operands.iter().flat_map(Operands::all_reads) {
        reads[place.registers()].iter_mut().for_each(|count| *count += 1);
    }
    // Backwards, so that inputs of removed operations also become dead.
    for ((op, operands), is_kept) in draft.ops.iter().zip(operands).zip(&mut draft.is_kept).rev() {
        let is_unread = || operands.writes.iter().all(|place| reads[place.registers()].iter().all(|&count| count == 0));
        if op.effect() != Effect::SideEffect && is_unread() {
            *is_kept = false;
            for place in operands.all_reads() {
                reads[place.registers()].iter_mut().for_each(|count| *count -= 1);
            }
        }
    }
    reads
}
