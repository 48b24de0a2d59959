//! Jump threading.

use vibrissa_runtime::machine::Op;

use super::draft::Draft;

/// Redirects jumps to jumps to their final targets, and removes jumps to the next operation.
pub(super) fn thread(draft: &mut Draft) {
    // For every operation, the next kept one from there on.
    let mut kept = vec![0; draft.ops.len() + 1];
    for run in &draft.runs {
        let mut next = run.end;
        kept[run.end] = run.end;
        // Backwards, so that the target of each jump is final before the jumps to it are processed.
        for index in run.clone().rev() {
            kept[index] = next;
            if !draft.is_kept[index] {
                continue;
            }
            let mut op = draft.ops[index];
            if let Some(target) = op.target_mut() {
                let place = kept[*target as usize];
                if place < run.end
                    && let Op::Jump { target: on } = draft.ops[place]
                {
                    *target = on;
                }
                if let Op::Jump { target } = op
                    && kept[target as usize] == next
                {
                    draft.is_kept[index] = false;
                    continue;
                }
            }
            draft.ops[index] = op;
            (kept[index], next) = (index, index);
        }
    }
}
