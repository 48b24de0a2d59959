//! What an operation reads and writes, and where it may go on: what the loader must know of code to trust it.

use super::op::{Op, Register};

/// What one operation does with the registers and with the order of the code.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Operands {
    /// Where the result and what is remembered go.
    pub(super) writes: [Place; 2],
    /// Where numbers are read, what is remembered among them.
    pub(super) reads: [Place; 3],
    /// Where the index of a whisker is read.
    pub(super) whisker: Option<Register>,
    /// Where a jump leads.
    pub(super) target: Option<u32>,
}

/// Neighbouring registers; none, by default.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Place {
    first: Register,
    width: u16,
}

impl Place {
    /// The indices of the registers.
    pub(super) fn registers(self) -> std::ops::Range<usize> {
        usize::from(self.first)..usize::from(self.first) + usize::from(self.width)
    }
}

/// The place of a number.
pub(super) fn number(first: Register) -> Place {
    Place { first, width: 1 }
}

/// The place of a vector.
fn vector(first: Register) -> Place {
    Place { first, width: 2 }
}

impl Operands {
    fn write(mut self, place: Place) -> Self {
        self.writes[0] = place;
        self
    }

    /// Remembers numbers from one use to the next.
    fn remember(mut self, memory: Place) -> Self {
        self.writes[1] = memory;
        self.reads[2] = memory;
        self
    }

    fn read<const N: usize>(mut self, places: [Place; N]) -> Self {
        self.reads[..N].copy_from_slice(&places);
        self
    }

    fn whisker(self, register: Register) -> Self {
        Self { whisker: Some(register), ..self }
    }

    fn jump(self, target: u32) -> Self {
        Self { target: Some(target), ..self }
    }
}

impl Op {
    /// What the operation does with the registers and with the order of the code.
    pub(super) fn operands(self) -> Operands {
        let operands = Operands::default();
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
            | Self::Not { to, a } => operands.write(number(to)).read([number(a)]),
            Self::Add { to, a, b }
            | Self::Subtract { to, a, b }
            | Self::Multiply { to, a, b }
            | Self::Divide { to, a, b }
            | Self::Minimum { to, a, b }
            | Self::Maximum { to, a, b }
            | Self::Less { to, a, b }
            | Self::LessOrEqual { to, a, b }
            | Self::Equal { to, a, b }
            | Self::And { to, a, b }
            | Self::Or { to, a, b } => operands.write(number(to)).read([number(a), number(b)]),
            Self::Clamp { to, a, low, high } => operands.write(number(to)).read([number(a), number(low), number(high)]),
            Self::Blend { to, a, b, share } => operands.write(vector(to)).read([vector(a), vector(b), number(share)]),
            Self::Distance { to, a, b } => operands.write(number(to)).read([vector(a), vector(b)]),
            Self::Norm { to, a } | Self::Angle { to, a } => operands.write(number(to)).read([vector(a)]),
            Self::AddVectors { to, a, b } | Self::SubtractVectors { to, a, b } => {
                operands.write(vector(to)).read([vector(a), vector(b)])
            }
            Self::Unit { to, a } | Self::NegateVector { to, a } => operands.write(vector(to)).read([vector(a)]),
            Self::Rotate { to, a, b } | Self::MultiplyVector { to, a, b } | Self::DivideVector { to, a, b } => {
                operands.write(vector(to)).read([vector(a), number(b)])
            }
            Self::Time { to } | Self::Body { to, .. } => operands.write(number(to)),
            Self::BodyPosition { to } => operands.write(vector(to)),
            Self::Whisker { to, whisker, .. } => operands.write(number(to)).whisker(whisker),
            Self::WhiskerVector { to, whisker, .. } => operands.write(vector(to)).whisker(whisker),
            Self::TipAt { to, whisker, a } | Self::ContourAt { to, whisker, a, .. } => {
                operands.write(vector(to)).whisker(whisker).read([number(a)])
            }
            Self::LowPass { to, a, b, memory } => {
                operands.write(number(to)).read([number(a), number(b)]).remember(Place { first: memory, width: 3 })
            }
            Self::Pid { to, a, gains, memory } => operands
                .write(number(to))
                .read([number(a), Place { first: gains, width: 4 }])
                .remember(Place { first: memory, width: 4 }),
            Self::Clear { memory, count } => operands.write(Place { first: memory, width: count }),
            Self::JumpUnless { a, target } => operands.read([number(a)]).jump(target),
            Self::Jump { target } => operands.jump(target),
            Self::Record { whisker } | Self::Mark { whisker, .. } => operands.whisker(whisker),
            Self::SteerBodyFacing { along, speed, heading: turn }
            | Self::SteerBodyTurning { along, speed, rate: turn } => {
                operands.read([vector(along), number(speed), number(turn)])
            }
            Self::SteerWhiskerFacing { whisker, along, speed, heading: turn }
            | Self::SteerWhiskerTurning { whisker, along, speed, rate: turn } => {
                operands.whisker(whisker).read([vector(along), number(speed), number(turn)])
            }
            Self::Hold | Self::Stop => operands,
        }
    }
}
