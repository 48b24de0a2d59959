//! What is known is not computed or asked for again, and copies are read where they come from.

use crate::machine::{Effect, Op, Place, Register, Role};

use super::draft::Draft;

/// How many values are remembered at a time: laws repeat themselves close by, and looking for one takes time.
const MEMORY: usize = 64;

/// An operation done before. Numbers of operations count from 1, so that 0 comes before all.
struct Known {
    number: usize,
    /// The operation with its result in register 0.
    op: Op,
    to: Register,
}

/// A register that holds what another one does.
struct Copied {
    number: usize,
    to: Register,
    from: Register,
}

/// What is known on the way through one run of the code.
struct Walk {
    known: Vec<Known>,
    copied: Vec<Copied>,
    /// The number of the operation that wrote each register last.
    written: Vec<usize>,
    /// The number of the operation that recorded a tip last.
    recorded: usize,
}

/// Copies what is known instead of computing it again, and reads copies where they come from.
pub(super) fn reuse(draft: &mut Draft) {
    let mut walk = Walk { known: Vec::new(), copied: Vec::new(), written: vec![0; draft.registers()], recorded: 0 };
    // For every operation, the first of the jumps that lead there.
    let mut jumps = vec![usize::MAX; draft.ops.len() + 1];
    for (index, op) in draft.ops.iter().enumerate().rev() {
        if let Some(target) = op.operands().target {
            jumps[target as usize] = index;
        }
    }
    for run in &draft.runs {
        walk.known.clear();
        walk.copied.clear();
        for index in run.clone() {
            // What was done behind a jump that leads here may have been left out.
            if jumps[index] != usize::MAX {
                walk.forget_after(jumps[index] + 1);
            }
            let op = walk.with_sources(draft.ops[index]);
            draft.ops[index] = walk.again(op).unwrap_or(op);
            walk.note(index + 1, draft.ops[index]);
        }
    }
}

impl Walk {
    /// Forgets what was done behind an operation.
    fn forget_after(&mut self, number: usize) {
        self.known.truncate(self.known.partition_point(|known| known.number <= number));
        self.copied.truncate(self.copied.partition_point(|copied| copied.number <= number));
    }

    /// An operation that reads copies where they come from.
    fn with_sources(&self, mut op: Op) -> Op {
        op.visit(|role, register| {
            let source = match role {
                Role::Read(1) | Role::Whisker => self.source(*register),
                Role::Read(2) => {
                    self.source(*register).filter(|&x| self.source(*register + 1).is_some_and(|y| y == x + 1))
                }
                _ => None,
            };
            *register = source.unwrap_or(*register);
        });
        op
    }

    /// Where a register is copied from, if both still hold the same.
    fn source(&self, register: Register) -> Option<Register> {
        let Copied { number, to, from } = *self.copied.iter().rev().find(|copied| copied.to == register)?;
        (self.written[usize::from(to)] == number && self.written[usize::from(from)] < number).then_some(from)
    }

    /// A copy that gives the same as an operation, if that has been done before and nothing has changed.
    fn again(&self, op: Op) -> Option<Op> {
        let (op, to) = placeless(op)?;
        let same = |known: &&Known| known.op == op && self.holds(known);
        let a = self.known.iter().rev().find(same)?.to;
        Some(if width(op) == 2 { Op::CopyVector { to, a } } else { Op::Copy { to, a } })
    }

    /// Whether an operation would give again what it gave.
    fn holds(&self, known: &Known) -> bool {
        let operands = known.op.operands();
        let first = usize::from(known.to);
        let results = &self.written[first..first + usize::from(width(known.op))];
        let mut read = operands.reads.into_iter().flat_map(Place::registers).chain(operands.whisker.map(usize::from));
        results.iter().all(|&written| written == known.number)
            && read.all(|register| self.written[register] < known.number)
            && (known.op.effect() != Effect::Feels || self.recorded < known.number)
    }

    /// Takes note of an operation.
    fn note(&mut self, number: usize, op: Op) {
        for register in op.operands().writes.into_iter().flat_map(Place::registers) {
            self.written[register] = number;
        }
        match op {
            Op::Copy { to, a: from } => self.copied.push(Copied { number, to, from }),
            Op::CopyVector { to, a } => {
                self.copied.extend([0, 1].map(|axis| Copied { number, to: to + axis, from: a + axis }));
            }
            Op::Record { .. } => self.recorded = number,
            _ => self.known.extend(placeless(op).map(|(op, to)| Known { number, op, to })),
        }
        if self.known.len() > MEMORY {
            self.known.drain(..MEMORY / 2);
        }
        if self.copied.len() > MEMORY {
            self.copied.drain(..MEMORY / 2);
        }
    }
}

/// An operation with its result in register 0, and where the result goes; `None` for one that does more than to give a result.
fn placeless(mut op: Op) -> Option<(Op, Register)> {
    if op.effect() == Effect::Acts {
        return None;
    }
    let mut to = 0;
    op.visit(|role, register| {
        if let Role::Write(_) = role {
            to = std::mem::take(register);
        }
    });
    Some((op, to))
}

/// How many numbers an operation gives.
fn width(op: Op) -> u16 {
    op.operands().writes[0].width
}
