//! Fusion: one operation in place of several.

use vibrissa_runtime::machine::{Op, Register};

use super::draft::Draft;

/// The maximum number of operations that one can replace.
const MAX_REPLACED: usize = 3;

/// Replaces consecutive operations by fused ones. `reads` has the number of reads of each register.
pub(super) fn fuse(draft: &mut Draft, reads: &[u32]) {
    let is_target = draft.targets();
    for run in draft.runs.clone() {
        let kept: Vec<usize> = run.filter(|&index| draft.is_kept[index]).collect();
        let ops: Vec<Op> = kept.iter().map(|&index| draft.ops[index]).collect();
        let mut next = 0;
        while next < kept.len() {
            let reached = |last: usize| is_target[kept[next] + 1..=last].contains(&true);
            let together =
                1 + kept[next + 1..].iter().take(MAX_REPLACED - 1).take_while(|&&last| !reached(last)).count();
            let (count, op) = fused(&ops[next..next + together], reads).unwrap_or((1, ops[next]));
            for &index in &kept[next..next + count - 1] {
                draft.is_kept[index] = false;
            }
            next += count;
            draft.ops[kept[next - 1]] = op;
        }
    }
}

/// The operation that can replace the first of `ops`, with the number of replaced operations.
fn fused(ops: &[Op], reads: &[u32]) -> Option<(usize, Op)> {
    // True if only the next operation reads the value.
    let is_passed = |from: Register, into: Register| from == into && reads[usize::from(from)] == 1;
    match *ops {
        [Op::Multiply { to: x, a, b }, Op::Multiply { to: y, a: c, b: d }, Op::Add { to, a: p, b: q }, ..]
            if is_passed(x, p) && is_passed(y, q) && (c, d) == (a + 1, b + 1) =>
        {
            Some((3, Op::Dot { to, a, b }))
        }
        [Op::Multiply { to: product, a, b }, Op::Add { to, a: c, b: summand }, ..] if is_passed(product, summand) => {
            Some((2, Op::MultiplyAdd { to, a, b, c }))
        }
        [Op::Whisker { to: value, whisker, quantity }, Op::Absolute { to, a }, ..] if is_passed(value, a) => {
            Some((2, Op::WhiskerSize { to, whisker, quantity }))
        }
        [Op::And { to, a, b }, Op::JumpUnless { a: truth, target }, ..] if is_passed(to, truth) => {
            Some((2, Op::JumpUnlessBoth { a, b, target }))
        }
        [Op::Cosine { to, a }, Op::Sine { to: y, a: same }, ..] if a == same && a != to && y == to + 1 => {
            Some((2, Op::Direction { to, a }))
        }
        [Op::Subtract { to: difference, a, b }, Op::Wrap { to, a: wrapped }, ..] if is_passed(difference, wrapped) => {
            Some((2, Op::Turn { to, a: b, b: a }))
        }
        [Op::Less { to, a, b }, Op::JumpUnless { a: truth, target }, ..] if is_passed(to, truth) => {
            Some((2, Op::JumpUnlessLess { a, b, target }))
        }
        [Op::Copy { to, a }, Op::Copy { to: y, a: b }, ..] if y == to + 1 && b == a + 1 && b != to => {
            Some((2, Op::CopyVector { to, a }))
        }
        _ => None,
    }
}
