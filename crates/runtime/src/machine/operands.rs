//! What an operation reads and writes, and where it may go on: what the loader must know of code to trust it, and the compiler
//! to shorten it.

use super::op::{Op, Register};

/// What one operation does with the registers.
#[derive(Debug, Clone, Copy, Default)]
pub struct Operands {
    /// Where the result and what is remembered go.
    pub writes: [RegisterSpan; 2],
    /// Where numbers are read, what is remembered among them.
    pub reads: [RegisterSpan; 3],
    /// Where the index of a whisker is read.
    pub whisker: Option<Register>,
}

impl Operands {
    /// Where anything is read: numbers, what is remembered, the index of a whisker.
    pub fn all_reads(&self) -> [RegisterSpan; 4] {
        let [a, b, c] = self.reads;
        [a, b, c, self.whisker.map_or_else(RegisterSpan::default, number)]
    }
}

/// Neighbouring registers; none, by default.
#[derive(Debug, Clone, Copy, Default)]
pub struct RegisterSpan {
    /// The first register.
    pub first: Register,
    /// The number of registers.
    pub width: u16,
}

impl RegisterSpan {
    /// The indices of the registers.
    pub fn registers(self) -> std::ops::Range<usize> {
        usize::from(self.first)..usize::from(self.first) + usize::from(self.width)
    }
}

/// The place of a number.
pub(super) fn number(first: Register) -> RegisterSpan {
    RegisterSpan { first, width: 1 }
}

/// What an operation has a register for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Role {
    /// The result goes there and to its neighbours, so many in all.
    Write(u16),
    /// A number or neighbouring numbers, so many in all, are read there.
    Read(u16),
    /// What is remembered is there and in its neighbours, so many in all.
    Memory(u16),
    /// The index of a whisker is read there.
    Whisker,
}

/// What an operation does besides writing its result.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Effect {
    /// Nothing, and its result follows from what it reads.
    Pure,
    /// Nothing, but it asks perception: the same question has the same answer until a tip is recorded.
    Sensing,
    /// Something: it remembers, jumps, records or commands.
    SideEffect,
}

impl Op {
    /// What the operation does besides writing its result.
    pub fn effect(self) -> Effect {
        match self {
            Self::Time { .. }
            | Self::Body { .. }
            | Self::BodyPosition { .. }
            | Self::Whisker { .. }
            | Self::WhiskerSize { .. }
            | Self::WhiskerVector { .. }
            | Self::TipAt { .. }
            | Self::ContourAt { .. } => Effect::Sensing,
            Self::LowPass { .. }
            | Self::Pid { .. }
            | Self::Clear { .. }
            | Self::JumpUnless { .. }
            | Self::JumpUnlessLess { .. }
            | Self::JumpUnlessBoth { .. }
            | Self::Jump { .. }
            | Self::Record { .. }
            | Self::Mark { .. }
            | Self::SteerBodyFacing { .. }
            | Self::SteerBodyTurning { .. }
            | Self::SteerWhiskerFacing { .. }
            | Self::SteerWhiskerTurning { .. }
            | Self::Hold
            | Self::Stop => Effect::SideEffect,
            _ => Effect::Pure,
        }
    }

    /// What the operation does with the registers.
    pub fn operands(mut self) -> Operands {
        let mut operands = Operands::default();
        let mut reads = 0;
        self.visit(|role, register| match role {
            Role::Write(width) => operands.writes[0] = RegisterSpan { first: *register, width },
            Role::Read(width) => {
                operands.reads[reads] = RegisterSpan { first: *register, width };
                reads += 1;
            }
            Role::Memory(width) => {
                operands.writes[1] = RegisterSpan { first: *register, width };
                operands.reads[2] = operands.writes[1];
            }
            Role::Whisker => operands.whisker = Some(*register),
        });
        operands
    }

    /// Where a jump leads.
    pub fn target(mut self) -> Option<u32> {
        self.target_mut().copied()
    }

    /// Where a jump leads, to be changed.
    pub fn target_mut(&mut self) -> Option<&mut u32> {
        match self {
            Self::JumpUnless { target, .. }
            | Self::JumpUnlessLess { target, .. }
            | Self::JumpUnlessBoth { target, .. }
            | Self::Jump { target } => Some(target),
            _ => None,
        }
    }

    /// Goes through the registers of the operation.
    #[expect(clippy::too_many_lines, reason = "one arm for operations alike")]
    pub fn visit(&mut self, mut visit: impl FnMut(Role, &mut Register)) {
        use Role::{Memory, Read, Whisker, Write};
        match self {
            Self::Copy { to, a }
            | Self::Negate { to, a }
            | Self::Absolute { to, a }
            | Self::Sign { to, a }
            | Self::SquareRoot { to, a }
            | Self::Sine { to, a }
            | Self::Cosine { to, a }
            | Self::Exponential { to, a }
            | Self::Floor { to, a }
            | Self::Wrap { to, a }
            | Self::Not { to, a } => {
                visit(Write(1), to);
                visit(Read(1), a);
            }
            Self::Add { to, a, b }
            | Self::Subtract { to, a, b }
            | Self::Multiply { to, a, b }
            | Self::Divide { to, a, b }
            | Self::Minimum { to, a, b }
            | Self::Maximum { to, a, b }
            | Self::Turn { to, a, b }
            | Self::Less { to, a, b }
            | Self::LessOrEqual { to, a, b }
            | Self::Equal { to, a, b }
            | Self::And { to, a, b }
            | Self::Or { to, a, b } => {
                visit(Write(1), to);
                visit(Read(1), a);
                visit(Read(1), b);
            }
            Self::Clamp { to, a, low: b, high: c } | Self::MultiplyAdd { to, a, b, c } => {
                visit(Write(1), to);
                visit(Read(1), a);
                visit(Read(1), b);
                visit(Read(1), c);
            }
            Self::Blend { to, a, b, share } => {
                visit(Write(2), to);
                visit(Read(2), a);
                visit(Read(2), b);
                visit(Read(1), share);
            }
            Self::Distance { to, a, b } | Self::Dot { to, a, b } => {
                visit(Write(1), to);
                visit(Read(2), a);
                visit(Read(2), b);
            }
            Self::Norm { to, a } | Self::Angle { to, a } => {
                visit(Write(1), to);
                visit(Read(2), a);
            }
            Self::AddVectors { to, a, b } | Self::SubtractVectors { to, a, b } => {
                visit(Write(2), to);
                visit(Read(2), a);
                visit(Read(2), b);
            }
            Self::CopyVector { to, a } | Self::Unit { to, a } | Self::NegateVector { to, a } => {
                visit(Write(2), to);
                visit(Read(2), a);
            }
            Self::Direction { to, a } => {
                visit(Write(2), to);
                visit(Read(1), a);
            }
            Self::Rotate { to, a, b } | Self::MultiplyVector { to, a, b } | Self::DivideVector { to, a, b } => {
                visit(Write(2), to);
                visit(Read(2), a);
                visit(Read(1), b);
            }
            Self::Time { to } | Self::Body { to, .. } => visit(Write(1), to),
            Self::BodyPosition { to } => visit(Write(2), to),
            Self::Whisker { to, whisker, .. } | Self::WhiskerSize { to, whisker, .. } => {
                visit(Write(1), to);
                visit(Whisker, whisker);
            }
            Self::WhiskerVector { to, whisker, .. } => {
                visit(Write(2), to);
                visit(Whisker, whisker);
            }
            Self::TipAt { to, whisker, a } | Self::ContourAt { to, whisker, a, .. } => {
                visit(Write(2), to);
                visit(Whisker, whisker);
                visit(Read(1), a);
            }
            Self::LowPass { to, a, b, memory } => {
                visit(Write(1), to);
                visit(Read(1), a);
                visit(Read(1), b);
                visit(Memory(3), memory);
            }
            Self::Pid { to, a, gains, memory } => {
                visit(Write(1), to);
                visit(Read(1), a);
                visit(Read(4), gains);
                visit(Memory(4), memory);
            }
            Self::Clear { memory, count } => visit(Write(*count), memory),
            Self::JumpUnless { a, .. } => visit(Read(1), a),
            Self::JumpUnlessLess { a, b, .. } | Self::JumpUnlessBoth { a, b, .. } => {
                visit(Read(1), a);
                visit(Read(1), b);
            }
            Self::Record { whisker } | Self::Mark { whisker, .. } => visit(Whisker, whisker),
            Self::SteerBodyFacing { along, speed, heading: turn }
            | Self::SteerBodyTurning { along, speed, rate: turn } => {
                visit(Read(2), along);
                visit(Read(1), speed);
                visit(Read(1), turn);
            }
            Self::SteerWhiskerFacing { whisker, along, speed, heading: turn }
            | Self::SteerWhiskerTurning { whisker, along, speed, rate: turn } => {
                visit(Whisker, whisker);
                visit(Read(2), along);
                visit(Read(1), speed);
                visit(Read(1), turn);
            }
            Self::Jump { .. } | Self::Hold | Self::Stop => {}
        }
    }
}
