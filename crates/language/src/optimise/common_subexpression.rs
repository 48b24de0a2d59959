//! Elimination of common subexpressions, and copy propagation.

use vibrissa_runtime::machine::{Effect, Op, Operands, Register, RegisterSpan, Role};

use super::draft::Draft;

/// The maximum number of candidates that are compared. Repetitions are usually close, and each comparison takes time.
const CANDIDATE_LIMIT: usize = 16;

/// A previous operation. Operations are numbered from 1, so 0 precedes all.
struct Known {
    number: usize,
    /// The operation with its result register set to 0.
    op: Op,
    operands: Operands,
    /// The previous operation with the same first input, numbered from 1.
    before: usize,
}

/// The known values during a pass through one range of the code.
struct KnownValues {
    known: Vec<Known>,
    /// For every register, the last known operation that reads it first, numbered from 1. The last entry is for
    /// operations that read none.
    last: Vec<usize>,
    /// The destinations of copies, each with the number of the copy.
    copied: Vec<(usize, Register)>,
    /// For every register that is a copy, the source.
    sources: Vec<Option<Register>>,
    /// The number of the operation that last wrote each register.
    written: Vec<usize>,
    /// The number of the last operation that recorded a tip.
    recorded: usize,
}

/// Replaces repeated computations by copies, and reads of copies by reads of their sources.
pub(super) fn eliminate(draft: &mut Draft) {
    let registers = draft.registers();
    let mut values = KnownValues {
        known: Vec::new(),
        last: vec![0; registers + 1],
        copied: Vec::new(),
        sources: vec![None; registers],
        written: vec![0; registers],
        recorded: 0,
    };
    // For every operation, the first jump that leads to it.
    let mut jumps = vec![usize::MAX; draft.ops.len() + 1];
    for (index, op) in draft.ops.iter().enumerate().rev() {
        if let Some(target) = op.target() {
            jumps[target as usize] = index;
        }
    }
    for run in &draft.runs {
        values.forget_after(0);
        for index in run.clone() {
            // The jump may have skipped the operations after it.
            if jumps[index] != usize::MAX {
                values.forget_after(jumps[index] + 1);
            }
            let op = values.with_sources(draft.ops[index]);
            draft.ops[index] = values.step(index + 1, op);
        }
    }
}

impl KnownValues {
    /// Forgets all operations after a number.
    fn forget_after(&mut self, number: usize) {
        while let Some(known) = self.known.pop_if(|known| known.number > number) {
            let first = self.first(&known.operands);
            self.last[first] = known.before;
        }
        while let Some((_, to)) = self.copied.pop_if(|(copied, _)| *copied > number) {
            self.sources[usize::from(to)] = None;
        }
    }

    /// The first register that an operation reads. The number of registers if it reads none.
    fn first(&self, operands: &Operands) -> usize {
        let read =
            operands.index.map(|(_, register)| usize::from(register)).or_else(|| operands.reads[0].registers().next());
        read.unwrap_or(self.sources.len())
    }

    /// The operation, reading the sources of copies.
    fn with_sources(&self, mut op: Op) -> Op {
        op.visit(|role, register| {
            let source = match role {
                Role::Read(1) | Role::Index(_) => self.source(*register),
                Role::Read(2) => {
                    self.source(*register).filter(|&x| self.source(*register + 1).is_some_and(|y| y == x + 1))
                }
                _ => None,
            };
            *register = source.unwrap_or(*register);
        });
        op
    }

    /// The source of a copy, if neither register has changed since.
    fn source(&self, register: Register) -> Option<Register> {
        let from = self.sources[usize::from(register)]?;
        (self.written[usize::from(from)] < self.written[usize::from(register)]).then_some(from)
    }

    /// Processes an operation. Returns its replacement: a copy, if the result is already known.
    fn step(&mut self, number: usize, op: Op) -> Op {
        let operands = op.operands();
        let result = operands.writes[0];
        let canonical = canonical(op);
        let op = match canonical.and_then(|canonical| self.known_result(canonical, &operands)) {
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
            _ if op.changes_senses() => self.recorded = number,
            _ => {
                if let Some(op) = canonical {
                    let first = self.first(&operands);
                    self.known.push(Known { number, op, operands, before: self.last[first] });
                    self.last[first] = self.known.len();
                }
            }
        }
        op
    }

    /// The register that already has the result of an operation, if its inputs have not changed.
    fn known_result(&self, canonical: Op, operands: &Operands) -> Option<Register> {
        let known = |at: usize| self.known.get(at.checked_sub(1)?);
        let alike = std::iter::successors(known(self.last[self.first(operands)]), |&alike| known(alike.before));
        let same = alike.take(CANDIDATE_LIMIT).find(|known| known.op == canonical && self.is_valid(known))?;
        Some(same.operands.writes[0].first)
    }

    /// True if an operation would give the same result again.
    fn is_valid(&self, known: &Known) -> bool {
        let written = |span: &RegisterSpan| self.written[span.registers()].iter();
        known.operands.writes.iter().flat_map(written).all(|&written| written == known.number)
            && known.operands.all_reads().iter().flat_map(written).all(|&written| written < known.number)
            && (known.op.effect() != Effect::Sensing || self.recorded < known.number)
    }

    fn copy(&mut self, number: usize, to: Register, from: Register) {
        self.copied.push((number, to));
        self.sources[usize::from(to)] = Some(from);
    }
}

/// The operation with its result register set to 0. `None` for a copy, and for operations with side effects.
fn canonical(mut op: Op) -> Option<Op> {
    if matches!(op, Op::Copy { .. } | Op::CopyVector { .. }) || op.effect() == Effect::SideEffect {
        return None;
    }
    op.visit(|role, register| {
        if let Role::Write(_) = role {
            *register = 0;
        }
    });
    Some(op)
}
