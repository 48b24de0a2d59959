//! The operations of compiled code.

use std::ops::Range;

use serde::{Deserialize, Serialize};

use super::senses::{BodyScalar, ContourVector, MapQuestion, MapScalar, MapVector, Mark, WhiskerScalar, WhiskerVector};

/// Index of a register.
pub type Register = u16;

/// Index of the first of two neighbouring registers, which contain x and y of a vector.
pub type Wide = u16;

/// A range of the program's code.
pub type Block = Range<u32>;

/// One operation. `to` is the register of the result. Booleans are 1 and 0.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[expect(missing_docs, reason = "operands are named alike throughout: to, a, b, and what the variant says")]
pub enum Op {
    /// `to = a`
    Copy { to: Register, a: Register },
    /// `to = a`, a vector
    CopyVector { to: Wide, a: Wide },
    /// `to = a + b`
    Add { to: Register, a: Register, b: Register },
    /// `to = a - b`
    Subtract { to: Register, a: Register, b: Register },
    /// `to = a * b`
    Multiply { to: Register, a: Register, b: Register },
    /// `to = a * b + c`, rounded twice
    MultiplyAdd { to: Register, a: Register, b: Register, c: Register },
    /// `to = a / b`
    Divide { to: Register, a: Register, b: Register },
    /// `to = -a`
    Negate { to: Register, a: Register },
    /// `to = |a|`
    Absolute { to: Register, a: Register },
    /// `to = sign(a)`: −1, 0 or 1
    Sign { to: Register, a: Register },
    /// `to = √a`
    SquareRoot { to: Register, a: Register },
    /// `to = min(a, b)`
    Minimum { to: Register, a: Register, b: Register },
    /// `to = max(a, b)`
    Maximum { to: Register, a: Register, b: Register },
    /// `to = min(max(a, low), high)`
    Clamp { to: Register, a: Register, low: Register, high: Register },
    /// `to = a` if `condition`, otherwise `to = b`
    Select { to: Register, condition: Register, a: Register, b: Register },
    /// `to = sin(a)`
    Sine { to: Register, a: Register },
    /// `to = cos(a)`
    Cosine { to: Register, a: Register },
    /// `to = e to the power of a`
    Exponential { to: Register, a: Register },
    /// `to = floor(a)`
    Floor { to: Register, a: Register },
    /// `to = a wrapped to (-π, π]`
    Wrap { to: Register, a: Register },
    /// `to = b - a`, the rotation from the angle a to the angle b, wrapped to (-π, π]
    Turn { to: Register, a: Register, b: Register },
    /// `to = a < b`
    Less { to: Register, a: Register, b: Register },
    /// `to = a <= b`
    LessOrEqual { to: Register, a: Register, b: Register },
    /// `to = a == b`
    Equal { to: Register, a: Register, b: Register },
    /// `to = a and b`
    And { to: Register, a: Register, b: Register },
    /// `to = a or b`
    Or { to: Register, a: Register, b: Register },
    /// `to = not a`
    Not { to: Register, a: Register },
    /// `to = a + b`, vectors
    AddVectors { to: Wide, a: Wide, b: Wide },
    /// `to = a - b`, vectors
    SubtractVectors { to: Wide, a: Wide, b: Wide },
    /// `to = -a`, a vector
    NegateVector { to: Wide, a: Wide },
    /// `to = the vector a times the number b`
    MultiplyVector { to: Wide, a: Wide, b: Register },
    /// `to = the vector a over the number b`
    DivideVector { to: Wide, a: Wide, b: Register },
    /// `to = (1 - share) a + share b`, vectors
    Blend { to: Wide, a: Wide, b: Wide, share: Register },
    /// `to = dot product of the vectors a and b`
    Dot { to: Register, a: Wide, b: Wide },
    /// `to = length of the vector a`
    Norm { to: Register, a: Wide },
    /// `to = length of a - b`, vectors
    Distance { to: Register, a: Wide, b: Wide },
    /// `to = the vector a at unit length`, or zero for a zero vector
    Unit { to: Wide, a: Wide },
    /// `to = direction of the vector a` (rad)
    Angle { to: Register, a: Wide },
    /// `to = the unit vector in the direction of the angle a`
    Direction { to: Wide, a: Register },
    /// `to = the vector a rotated by the angle b`
    Rotate { to: Wide, a: Wide, b: Register },
    /// `to = time since the start of the run`
    Time { to: Register },
    /// `to = a quantity of the body`
    Body { to: Register, quantity: BodyScalar },
    /// `to = position of the body`
    BodyPosition { to: Wide },
    /// `to = a quantity of a whisker or of a contour`
    Whisker { to: Register, whisker: Register, quantity: WhiskerScalar },
    /// `to = the absolute value of a quantity of a whisker`
    WhiskerSize { to: Register, whisker: Register, quantity: WhiskerScalar },
    /// `to = a vector of a whisker or of a contour`
    WhiskerVector { to: Wide, whisker: Register, quantity: WhiskerVector },
    /// `to = the position of a whisker's tip at the base angle a, in the frame of its base`
    TipAt { to: Wide, whisker: Register, a: Register },
    /// `to = true if the whisker closed a loop` within the distance a, at least the time b after its first tip
    LoopClosed { to: Register, whisker: Register, a: Register, b: Register },
    /// `to = a vector of a contour at the distance a behind its end`
    ContourAt { to: Wide, contour: Register, a: Register, quantity: ContourVector },
    /// `to = a through a first-order low-pass filter with the cutoff b` (Hz). Its memory is three registers.
    LowPass { to: Register, a: Register, b: Register, memory: Register },
    /// `to = output of a PID controller` for the error `a`. `gains` are four registers: p, i, d and the output limit.
    /// Its memory is four registers.
    Pid { to: Register, a: Register, gains: Register, memory: Register },
    /// Adds one to `counter`, and `to = counter`.
    Count { to: Register, counter: Register },
    /// Sets `count` registers of memory from `memory` on to zero.
    Clear { memory: Register, count: u16 },
    /// Continues at `target` unless `a`. `target` is ahead.
    JumpUnless { a: Register, target: u32 },
    /// Continues at `target` unless `a < b`. `target` is ahead.
    JumpUnlessLess { a: Register, b: Register, target: u32 },
    /// Continues at `target` unless both `a` and `b`. `target` is ahead.
    JumpUnlessBoth { a: Register, b: Register, target: u32 },
    /// Continues at `target`, which is ahead.
    Jump { target: u32 },
    /// Records a whisker's tip as a point of the estimated contour.
    Record { whisker: Register },
    /// Records the position `a` as a point of the contour with this index in the program's list of contours.
    RecordPosition { contour: u16, a: Wide },
    /// Records a mark of a whisker.
    Mark { whisker: Register, mark: Mark },
    /// Moves the body and rotates it to a heading.
    SteerBodyFacing { along: Wide, speed: Register, heading: Register },
    /// Moves the body and rotates it at a yaw rate.
    SteerBodyTurning { along: Wide, speed: Register, rate: Register },
    /// Moves a whisker's base and rotates the body to a heading.
    SteerWhiskerFacing { whisker: Register, along: Wide, speed: Register, heading: Register },
    /// Moves a whisker's base and rotates the body at a yaw rate.
    SteerWhiskerTurning { whisker: Register, along: Wide, speed: Register, rate: Register },
    /// Keeps the last command.
    Hold,
    /// Stops the platform.
    Stop,
    /// `to = a quantity of the map`
    Map { to: Register, quantity: MapScalar },
    /// `to = a vector of the map`
    MapVector { to: Wide, quantity: MapVector },
    /// `to = true if a statement holds in the map` for the position a and the heading b
    MapHolds { to: Register, a: Wide, b: Register, question: MapQuestion },
    /// Sets the goal of the map's route to the position `a` and the heading `b`.
    GoTo { a: Wide, b: Register },
    /// Tells the map that its next target could not be touched.
    GiveUp,
    /// Tells the map that something was felt at the position `a`, with free ground in the direction `b`.
    Felt { a: Wide, b: Wide },
}
