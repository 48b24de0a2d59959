//! Operands, jump targets and effects of operations. The verifier relies on them, and so does the optimiser of the
//! compiler.

use super::op::{Op, Register};

/// The registers that one operation reads and writes.
#[derive(Debug, Clone, Copy, Default)]
pub struct Operands {
    /// Registers of the result and of the memory that are written.
    pub writes: [RegisterSpan; 2],
    /// Registers of numbers that are read, including the memory.
    pub reads: [RegisterSpan; 3],
    /// Register of the index of a whisker or a contour that is read.
    pub index: Option<(Index, Register)>,
}

impl Operands {
    /// All registers that are read: numbers, memory and the index of a whisker or a contour.
    #[must_use]
    pub fn all_reads(&self) -> [RegisterSpan; 4] {
        let [a, b, c] = self.reads;
        [a, b, c, self.index.map_or_else(RegisterSpan::default, |(_, register)| number(register))]
    }
}

/// Neighbouring registers. The default is none.
#[derive(Debug, Clone, Copy, Default)]
pub struct RegisterSpan {
    /// The first register.
    pub first: Register,
    /// The number of registers.
    pub width: u16,
}

impl RegisterSpan {
    /// The indices of the registers.
    #[must_use]
    pub fn registers(self) -> std::ops::Range<usize> {
        usize::from(self.first)..usize::from(self.first) + usize::from(self.width)
    }
}

/// The span of a single number.
pub(super) fn number(first: Register) -> RegisterSpan {
    RegisterSpan { first, width: 1 }
}

/// The role of a register in an operation.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Role {
    /// The result is written to this many registers.
    Write(u16),
    /// This many neighbouring numbers are read.
    Read(u16),
    /// This many registers are the memory of a stateful operation. They are read and written.
    Memory(u16),
    /// The index of a whisker or a contour is read.
    Index(Index),
}

/// The list to which an index belongs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Index {
    /// The whiskers.
    Whisker,
    /// The contours: those of the whiskers, and after these the contours through positions.
    Contour,
}

impl Index {
    /// The list for a quantity that every contour has, or that only whiskers have.
    fn of(is_of_contour: bool) -> Self {
        if is_of_contour { Self::Contour } else { Self::Whisker }
    }
}

/// The effect of an operation besides its result.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Effect {
    /// No effect. The result depends only on the operands.
    Pure,
    /// No effect, but the result depends on perception or on the map. Until a tip is recorded, or the map gets an event, the
    /// same operation has the same result.
    Sensing,
    /// A side effect: it changes memory, jumps, records or gives an action.
    SideEffect,
}

impl Op {
    /// The effect of the operation besides its result.
    #[must_use]
    pub fn effect(self) -> Effect {
        match self {
            Self::Time { .. }
            | Self::Body { .. }
            | Self::BodyPosition { .. }
            | Self::Whisker { .. }
            | Self::WhiskerSize { .. }
            | Self::WhiskerVector { .. }
            | Self::TipAt { .. }
            | Self::LoopClosed { .. }
            | Self::ContourAt { .. }
            | Self::Map { .. }
            | Self::MapVector { .. }
            | Self::MapHolds { .. } => Effect::Sensing,
            Self::LowPass { .. }
            | Self::Pid { .. }
            | Self::Count { .. }
            | Self::Clear { .. }
            | Self::JumpUnless { .. }
            | Self::JumpUnlessLess { .. }
            | Self::JumpUnlessBoth { .. }
            | Self::Jump { .. } => Effect::SideEffect,
            _ if self.is_action() => Effect::SideEffect,
            _ => Effect::Pure,
        }
    }

    /// The register of the result, if the operation compares numbers or joins bools.
    #[must_use]
    pub fn bool_result(self) -> Option<Register> {
        match self {
            Self::And { to, .. }
            | Self::Or { to, .. }
            | Self::Not { to, .. }
            | Self::Less { to, .. }
            | Self::LessOrEqual { to, .. }
            | Self::Equal { to, .. } => Some(to),
            _ => None,
        }
    }

    /// True if the operation reads the map or tells it something.
    #[must_use]
    pub fn is_of_map(self) -> bool {
        matches!(
            self,
            Self::Map { .. }
                | Self::MapVector { .. }
                | Self::MapHolds { .. }
                | Self::GoTo { .. }
                | Self::GiveUp
                | Self::Felt { .. }
        )
    }

    /// True if the operation changes what later operations of the same tick sense.
    #[must_use]
    pub fn changes_senses(self) -> bool {
        matches!(
            self,
            Self::Record { .. } | Self::RecordPosition { .. } | Self::GoTo { .. } | Self::GiveUp | Self::Felt { .. }
        )
    }

    /// True if the operation records, marks, tells the map something or gives a command.
    #[must_use]
    pub fn is_action(self) -> bool {
        matches!(
            self,
            Self::GoTo { .. }
                | Self::GiveUp
                | Self::Felt { .. }
                | Self::Record { .. }
                | Self::RecordPosition { .. }
                | Self::Mark { .. }
                | Self::SteerBodyFacing { .. }
                | Self::SteerBodyTurning { .. }
                | Self::SteerWhiskerFacing { .. }
                | Self::SteerWhiskerTurning { .. }
                | Self::Hold
                | Self::Stop
        )
    }

    /// The registers that the operation reads and writes.
    #[must_use]
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
            Role::Index(index) => operands.index = Some((index, *register)),
        });
        operands
    }

    /// Target of a jump.
    #[must_use]
    pub fn target(mut self) -> Option<u32> {
        self.target_mut().copied()
    }

    /// Mutable target of a jump.
    pub fn target_mut(&mut self) -> Option<&mut u32> {
        match self {
            Self::JumpUnless { target, .. }
            | Self::JumpUnlessLess { target, .. }
            | Self::JumpUnlessBoth { target, .. }
            | Self::Jump { target } => Some(target),
            _ => None,
        }
    }

    /// Calls `visit` for every register of the operation.
    #[expect(clippy::too_many_lines, reason = "one arm for operations alike")]
    pub fn visit(&mut self, mut visit: impl FnMut(Role, &mut Register)) {
        use Role::{Memory, Read, Write};
        let whisker_index = Role::Index(Index::Whisker);
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
            Self::Clamp { to, a, low: b, high: c }
            | Self::MultiplyAdd { to, a, b, c }
            | Self::Select { to, condition: a, a: b, b: c } => {
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
            Self::Time { to } | Self::Body { to, .. } | Self::Map { to, .. } => visit(Write(1), to),
            Self::BodyPosition { to } | Self::MapVector { to, .. } => visit(Write(2), to),
            Self::MapHolds { to, a, b, .. } => {
                visit(Write(1), to);
                visit(Read(2), a);
                visit(Read(1), b);
            }
            Self::GoTo { a, b } => {
                visit(Read(2), a);
                visit(Read(1), b);
            }
            Self::Felt { a, b } => {
                visit(Read(2), a);
                visit(Read(2), b);
            }
            Self::Whisker { to, whisker, quantity } | Self::WhiskerSize { to, whisker, quantity } => {
                visit(Write(1), to);
                visit(Role::Index(Index::of(quantity.is_of_contour())), whisker);
            }
            Self::WhiskerVector { to, whisker, quantity } => {
                visit(Write(2), to);
                visit(Role::Index(Index::of(quantity.is_of_contour())), whisker);
            }
            Self::TipAt { to, whisker, a } => {
                visit(Write(2), to);
                visit(whisker_index, whisker);
                visit(Read(1), a);
            }
            Self::LoopClosed { to, whisker, a, b } => {
                visit(Write(1), to);
                visit(whisker_index, whisker);
                visit(Read(1), a);
                visit(Read(1), b);
            }
            Self::ContourAt { to, contour, a, .. } => {
                visit(Write(2), to);
                visit(Role::Index(Index::Contour), contour);
                visit(Read(1), a);
            }
            Self::RecordPosition { a, .. } => visit(Read(2), a),
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
            Self::Count { to, counter } => {
                visit(Write(1), to);
                visit(Memory(1), counter);
            }
            Self::Clear { memory, count } => visit(Write(*count), memory),
            Self::JumpUnless { a, .. } => visit(Read(1), a),
            Self::JumpUnlessLess { a, b, .. } | Self::JumpUnlessBoth { a, b, .. } => {
                visit(Read(1), a);
                visit(Read(1), b);
            }
            Self::Record { whisker } | Self::Mark { whisker, .. } => visit(whisker_index, whisker),
            Self::SteerBodyFacing { along, speed, heading: turn }
            | Self::SteerBodyTurning { along, speed, rate: turn } => {
                visit(Read(2), along);
                visit(Read(1), speed);
                visit(Read(1), turn);
            }
            Self::SteerWhiskerFacing { whisker, along, speed, heading: turn }
            | Self::SteerWhiskerTurning { whisker, along, speed, rate: turn } => {
                visit(whisker_index, whisker);
                visit(Read(2), along);
                visit(Read(1), speed);
                visit(Read(1), turn);
            }
            Self::Jump { .. } | Self::GiveUp | Self::Hold | Self::Stop => {}
        }
    }
}
