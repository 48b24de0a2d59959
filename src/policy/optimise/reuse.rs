//! What is known is not computed or asked for again, and copies are read where they come from.

use vibrissa_runtime::machine::{Effect, Op, Operands, Place, Register, Role};

use super::draft::Draft;

/// How many values that come of the same register are looked through: laws repeat themselves close by, and looking takes time.
const LOOKS: usize = 16;

/// An operation done before. Numbers of operations count from 1, so that 0 comes before all.
struct Known {
    number: usize,
    /// The operation with its result in register 0.
    op: Op,
    operands: Operands,
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
        if let Some(target) = op.target() {
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
            draft.ops[index] = walk.step(index + 1, op);
        }
    }
}

impl Walk {
    /// Forgets what was done behind an operation.
    fn forget_after(&mut self, number: usize) {
        while let Some(known) = self.known.pop_if(|known| known.number > number) {
            let first = self.first(&known.operands);
            self.last[first] = known.before;
        }
        while let Some((_, to)) = self.copied.pop_if(|(copied, _)| *copied > number) {
            self.sources[usize::from(to)] = None;
        }
    }

    /// The register that an operation reads first, or the number of registers for one that reads none.
    fn first(&self, operands: &Operands) -> usize {
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

    /// Goes on behind an operation. Gives what takes its place: a copy, if the same has been done before.
    fn step(&mut self, number: usize, op: Op) -> Op {
        let operands = op.operands();
        let result = operands.writes[0];
        let placeless = placeless(op);
        let op = match placeless.and_then(|placeless| self.again(placeless, &operands)) {
            Some(a) if result.width == 2 => Op::CopyVector { to: result.first, a },
            Some(a) => Op::Copy { to: result.first, a },
            None => op,
        };
        for place in operands.writes {
            self.written[place.registers()].fill(number);
            self.sources[place.registers()].fill(None);
        }
        match op {
            Op::Copy { to, a } => self.copy(number, to, a),
            Op::CopyVector { to, a } => [0, 1].into_iter().for_each(|axis| self.copy(number, to + axis, a + axis)),
            Op::Record { .. } => self.recorded = number,
            _ => {
                if let Some(op) = placeless {
                    let first = self.first(&operands);
                    self.known.push(Known { number, op, operands, before: self.last[first] });
                    self.last[first] = self.known.len();
                }
            }
        }
        op
    }

    /// Where the result of an operation is already, if that has been done before and nothing has changed.
    fn again(&self, placeless: Op, operands: &Operands) -> Option<Register> {
        let known = |at: usize| self.known.get(at.checked_sub(1)?);
        let alike = std::iter::successors(known(self.last[self.first(operands)]), |&alike| known(alike.before));
        let same = alike.take(LOOKS).find(|known| known.op == placeless && self.holds(known))?;
        Some(same.operands.writes[0].first)
    }

    /// Whether an operation would give again what it gave.
    fn holds(&self, known: &Known) -> bool {
        let written = |place: &Place| self.written[place.registers()].iter();
        known.operands.writes.iter().flat_map(written).all(|&written| written == known.number)
            && known.operands.all_reads().iter().flat_map(written).all(|&written| written < known.number)
            && (known.op.effect() != Effect::Feels || self.recorded < known.number)
    }

    fn copy(&mut self, number: usize, to: Register, from: Register) {
        self.copied.push((number, to));
        self.sources[usize::from(to)] = Some(from);
    }
}

/// An operation with its result in register 0; `None` for a copy, and for one that does more than to give a result.
fn placeless(mut op: Op) -> Option<Op> {
    if matches!(op, Op::Copy { .. } | Op::CopyVector { .. }) || op.effect() == Effect::Acts {
        return None;
    }
    op.visit(|role, register| {
        if let Role::Write(_) = role {
            *register = 0;
        }
    });
    Some(op)
}
