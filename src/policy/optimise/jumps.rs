//! Jumps lead where they end.

use vibrissa_runtime::machine::Op;

use super::draft::Draft;

/// Lets jumps to jumps lead where those do, and strikes out jumps to what comes next anyway.
pub(super) fn shorten(draft: &mut Draft) {
    // For every operation, the first from there on that is kept.
    let mut kept = vec![0; draft.ops.len() + 1];
    for run in &draft.runs {
        let mut next = run.end;
        kept[run.end] = run.end;
        // From behind, so that every jump is met by those to it when it leads where it ends.
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
