//! The code and the registers of a program in the making.

use std::collections::BTreeMap;

use vibrissa_runtime::machine::{Block, CODE_LIMIT, Op, REGISTER_LIMIT, Register};

/// The code and the registers of a program in the making.
#[derive(Debug)]
pub(super) struct Code {
    pub(super) ops: Vec<Op>,
    /// What registers hold at the start of a run.
    pub(super) image: Vec<f64>,
    /// Registers of constants, by their bits.
    constants: BTreeMap<u64, Register>,
    /// Whether the program outgrew its limits, from when on nothing more is written.
    pub(super) full: bool,
}

/// An amount of code.
#[derive(Debug, Clone, Copy)]
pub(super) struct Mark {
    ops: usize,
    registers: usize,
}

impl Code {
    pub(super) fn new() -> Self {
        Self { ops: Vec::new(), image: Vec::new(), constants: BTreeMap::new(), full: false }
    }

    /// How much there is, to [`rewind`](Self::rewind) to.
    pub(super) fn mark(&self) -> Mark {
        Mark { ops: self.ops.len(), registers: self.image.len() }
    }

    /// Throws away what was written since `mark`.
    pub(super) fn rewind(&mut self, mark: Mark) {
        self.ops.truncate(mark.ops);
        self.image.truncate(mark.registers);
        self.constants.retain(|_, register| usize::from(*register) < mark.registers);
    }

    /// A fresh place for `width` numbers.
    pub(super) fn place(&mut self, width: u16) -> Register {
        if self.image.len() + usize::from(width) > REGISTER_LIMIT {
            self.full = true;
            return 0;
        }
        let register = Register::try_from(self.image.len()).unwrap_or(0);
        self.image.resize(self.image.len() + usize::from(width), 0.0);
        register
    }

    /// A place that holds `value` from the start.
    pub(super) fn constant(&mut self, value: f64) -> Register {
        if let Some(&register) = self.constants.get(&value.to_bits()) {
            return register;
        }
        let register = self.place(1);
        if let Some(cell) = self.image.get_mut(usize::from(register))
            && !self.full
        {
            *cell = value;
            self.constants.insert(value.to_bits(), register);
        }
        register
    }

    /// Writes one operation.
    pub(super) fn push(&mut self, op: Op) {
        if self.ops.len() >= CODE_LIMIT {
            self.full = true;
        } else if !self.full {
            self.ops.push(op);
        }
    }

    /// Writes an operation whose result is one number, and says where that will be.
    pub(super) fn scalar(&mut self, op: impl FnOnce(Register) -> Op) -> Register {
        let to = self.place(1);
        self.push(op(to));
        to
    }

    /// Writes an operation whose result is a vector, and says where that will be.
    pub(super) fn vector(&mut self, op: impl FnOnce(Register) -> Op) -> Register {
        let to = self.place(2);
        self.push(op(to));
        to
    }

    /// Takes back the last operation if it is a difference of vectors; gives the places of the two.
    pub(super) fn take_difference(&mut self) -> Option<(Register, Register)> {
        let Some(&Op::SubtractVectors { a, b, .. }) = self.ops.last() else { return None };
        if self.full {
            return None;
        }
        self.ops.pop();
        Some((a, b))
    }

    /// Copies `width` numbers.
    pub(super) fn copy(&mut self, to: Register, from: Register, width: u16) {
        for offset in 0..width {
            self.push(Op::Copy { to: to + offset, a: from + offset });
        }
    }

    /// Where the next operation will be.
    pub(super) fn here(&self) -> u32 {
        u32::try_from(self.ops.len()).unwrap_or(u32::MAX)
    }

    /// What was written since `start`.
    pub(super) fn since(&self, start: u32) -> Block {
        start..self.here()
    }

    /// Lets the jump at `jump` lead to the next operation.
    pub(super) fn land(&mut self, jump: u32) {
        let here = self.here();
        if let Some(Op::Jump { target } | Op::JumpUnless { target, .. }) = self.ops.get_mut(jump as usize) {
            *target = here;
        }
    }
}
