//! What is known is not computed or asked for again, and copies are read where they come from.

use crate::machine::{Effect, Op, Place, Register, Role};

use super::draft::Draft;

/// How many values that come of the same register are looked through: laws repeat themselves close by, and looking takes time.
const LOOKS: usize = 16;

/// An operation done before. Numbers of operations count from 1, so that 0 comes before all.
struct Known {
    number: usize,
    /// The operation with its result in register 0.
    op: Op,
    to: Register,
    /// The one before it that comes of the same register, counted from 1.
    before: usize,
}

/// What is known on the way through one run of the code.
struct Walk {
    known: Vec<Known>,
    /// For every register, the last known operation that reads it first, counted from 1; behind them, that of those that read none.
    last: Vec<usize>,
    /// The registers that were copied into, each with the number of the copy.
    copied: Vec<(usize, Register)>,
    /// For every register that was copied into, where from.
    sources: Vec<Option<Register>>,
    /// The number of the operation that wrote each register last.
    written: Vec<usize>,
    /// The number of the operation that recorded a tip last.
    recorded: usize,
}

/// Copies what is known instead of computing it again, and reads copies where they come from.
pub(super) fn reuse(draft: &mut Draft) {
    let registers = draft.registers();
    let mut walk = Walk {
        known: Vec::new(),
        last: vec![0; registers + 1],
        copied: Vec::new(),
        sources: vec![None; registers],
        written: vec![0; registers],
        recorded: 0,
    };
    // For every operation, the first of the jumps that lead there.
    let mut jumps = vec![usize::MAX; draft.ops.len() + 1];
    for (index, op) in draft.ops.iter().enumerate().rev() {
        if let Some(target) = op.operands().target {
            jumps[target as usize] = index;
        }
    }
    for run in &draft.runs {
        walk.forget_after(0);
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
        while let Some(known) = self.known.pop_if(|known| known.number > number) {
            let first = self.first(known.op);
            self.last[first] = known.before;
        }
        while let Some((_, to)) = self.copied.pop_if(|(copied, _)| *copied > number) {
            self.sources[usize::from(to)] = None;
        }
    }

    /// The register that an operation reads first, or the number of registers for one that reads none.
    fn first(&self, op: Op) -> usize {
        let operands = op.operands();
        let read = operands.whisker.map(usize::from).or_else(|| operands.reads[0].registers().next());
        read.unwrap_or(self.sources.len())
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
        let from = self.sources[usize::from(register)]?;
        (self.written[usize::from(from)] < self.written[usize::from(register)]).then_some(from)
    }

    /// A copy that gives the same as an operation, if that has been done before and nothing has changed.
    fn again(&self, op: Op) -> Option<Op> {
        let (op, to) = placeless(op)?;
        let known = |at: usize| self.known.get(at.checked_sub(1)?);
        let alike = std::iter::successors(known(self.last[self.first(op)]), |&alike| known(alike.before));
        let a = alike.take(LOOKS).find(|known| known.op == op && self.holds(known))?.to;
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
            self.sources[register] = None;
        }
        match op {
            Op::Copy { to, a } => self.copy(number, to, a),
            Op::CopyVector { to, a } => [0, 1].into_iter().for_each(|axis| self.copy(number, to + axis, a + axis)),
            Op::Record { .. } => self.recorded = number,
            _ => {
                if let Some((op, to)) = placeless(op) {
                    let first = self.first(op);
                    self.known.push(Known { number, op, to, before: self.last[first] });
                    self.last[first] = self.known.len();
                }
            }
        }
    }

    fn copy(&mut self, number: usize, to: Register, from: Register) {
        self.copied.push((number, to));
        self.sources[usize::from(to)] = Some(from);
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
