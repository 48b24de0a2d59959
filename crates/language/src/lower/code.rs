//! Generated code and its registers.

use std::collections::BTreeMap;

use vibrissa_runtime::machine::{Block, CODE_LIMIT, Op, Outputs, REGISTER_LIMIT, Register};
use vibrissa_runtime::units::Dimension;

use vibrissa_text::diagnostic::Span;

/// The code and registers of a program that is being generated.
#[derive(Debug)]
pub(super) struct Code {
    pub(super) ops: Vec<Op>,
    /// Initial values of the registers.
    pub(super) initial: Vec<f64>,
    /// Registers of constants, by their bits.
    constants: BTreeMap<u64, Register>,
    /// The bits of the constants in the order of their registers.
    constant_bits: Vec<u64>,
    /// The expressions whose values are in the registers.
    pub(super) origins: Origins,
    /// The plots and messages.
    pub(super) outputs: Outputs,
    /// For every message, the spans of its values.
    pub(super) logged: Vec<Vec<Span>>,
    /// True if the program exceeded its limits. No more code is emitted then.
    pub(super) full: bool,
}

/// The expression of each register that has one.
#[derive(Debug, Default)]
pub(crate) struct Origins(Vec<Option<Origin>>);

/// The expression whose value is in a register.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Origin {
    /// Span of the expression. Of a derived value, it is the span of its definition.
    pub(crate) span: Span,
    /// The dimension of the compared numbers, if it is a comparison of numbers.
    pub(crate) compared: Option<Dimension>,
}

impl Origins {
    /// The expression of a register.
    pub(crate) fn get(&self, register: Register) -> Option<Origin> {
        self.0.get(usize::from(register)).copied().flatten()
    }

    /// Notes the innermost expression of a register. The first one counts, but a comparison replaces it.
    pub(super) fn note(&mut self, register: Register, origin: Origin) {
        let index = usize::from(register);
        if self.0.len() <= index {
            self.0.resize(index + 1, None);
        }
        if let Some(known) = self.0.get_mut(index)
            && (known.is_none() || origin.compared.is_some())
        {
            *known = Some(origin);
        }
    }
}

/// A position in the code.
#[derive(Debug, Clone, Copy)]
pub(super) struct Mark {
    ops: usize,
    registers: usize,
    plots: usize,
    messages: usize,
    counter: Register,
}

impl Code {
    pub(super) fn new() -> Self {
        Self {
            ops: Vec::new(),
            initial: Vec::new(),
            constants: BTreeMap::new(),
            constant_bits: Vec::new(),
            origins: Origins::default(),
            outputs: Outputs::default(),
            logged: Vec::new(),
            full: false,
        }
    }

    /// The current position, for [`rewind`](Self::rewind).
    pub(super) fn mark(&self) -> Mark {
        Mark {
            ops: self.ops.len(),
            registers: self.initial.len(),
            plots: self.outputs.plots.len(),
            messages: self.outputs.messages.len(),
            counter: self.outputs.counter,
        }
    }

    /// Discards the code after `mark`.
    pub(super) fn rewind(&mut self, mark: Mark) {
        self.ops.truncate(mark.ops);
        self.initial.truncate(mark.registers);
        let constants = &self.constants;
        let is_behind =
            |bits: &mut u64| constants.get(bits).is_none_or(|&register| usize::from(register) >= mark.registers);
        let mut behind = Vec::new();
        while let Some(bits) = self.constant_bits.pop_if(is_behind) {
            behind.push(bits);
        }
        for bits in behind {
            self.constants.remove(&bits);
        }
        self.origins.0.truncate(mark.registers);
        self.outputs.plots.truncate(mark.plots);
        self.outputs.messages.truncate(mark.messages);
        self.outputs.counter = mark.counter;
        self.logged.truncate(mark.messages);
    }

    /// The first of `width` new registers.
    pub(super) fn allocate(&mut self, width: u16) -> Register {
        if self.initial.len() + usize::from(width) > REGISTER_LIMIT {
            self.full = true;
            return 0;
        }
        let register = Register::try_from(self.initial.len()).unwrap_or(0);
        self.initial.resize(self.initial.len() + usize::from(width), 0.0);
        register
    }

    /// A register with the constant `value`.
    pub(super) fn constant(&mut self, value: f64) -> Register {
        if let Some(&register) = self.constants.get(&value.to_bits()) {
            return register;
        }
        let register = self.allocate(1);
        if let Some(cell) = self.initial.get_mut(usize::from(register))
            && !self.full
        {
            *cell = value;
            self.constants.insert(value.to_bits(), register);
            self.constant_bits.push(value.to_bits());
        }
        register
    }

    /// Emits an operation.
    pub(super) fn push(&mut self, op: Op) {
        if self.ops.len() >= CODE_LIMIT {
            self.full = true;
        } else if !self.full {
            self.ops.push(op);
        }
    }

    /// Emits an operation whose result is a number. Returns its register.
    pub(super) fn scalar(&mut self, op: impl FnOnce(Register) -> Op) -> Register {
        let to = self.allocate(1);
        self.push(op(to));
        to
    }

    /// Emits an operation whose result is a vector. Returns its first register.
    pub(super) fn vector(&mut self, op: impl FnOnce(Register) -> Op) -> Register {
        let to = self.allocate(2);
        self.push(op(to));
        to
    }

    /// Removes the last operation if it is a difference of vectors. Returns its operands.
    pub(super) fn take_difference(&mut self) -> Option<(Register, Register)> {
        let Some(&Op::SubtractVectors { a, b, .. }) = self.ops.last() else { return None };
        if self.full {
            return None;
        }
        self.ops.pop();
        Some((a, b))
    }

    /// Copies `width` registers.
    pub(super) fn copy(&mut self, to: Register, from: Register, width: u16) {
        for offset in 0..width {
            self.push(Op::Copy { to: to + offset, a: from + offset });
        }
    }

    /// Index of the next operation.
    pub(super) fn here(&self) -> u32 {
        u32::try_from(self.ops.len()).unwrap_or(u32::MAX)
    }

    /// The block of code since `start`.
    pub(super) fn since(&self, start: u32) -> Block {
        start..self.here()
    }

    /// Sets the target of the jump at `jump` to the next operation.
    pub(super) fn set_jump_target(&mut self, jump: u32) {
        let here = self.here();
        if let Some(Op::Jump { target } | Op::JumpUnless { target, .. }) = self.ops.get_mut(jump as usize) {
            *target = here;
        }
    }
}
