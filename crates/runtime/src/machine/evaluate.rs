//! The evaluator: runs a block of code over the registers.
//!
//! Why: docs/decisions/machine.md#the-evaluator-is-an-optimised-interpreter.

use std::cmp::Ordering;

use crate::geometry::{Vector2, rotate, turn_between, unit, wrap};
use crate::math;

use super::action::{Action, Mover, Turn};
use super::op::{Block, Op, Register, Wide};
use super::senses::Senses;
use super::stateful;

/// Executes `block` of `code` and returns true if it gave an action. The last action given replaces `action`.
///
/// The action is an output parameter, because moving an action costs as much as several operations.
#[expect(clippy::too_many_lines, reason = "one arm an operation")]
pub(super) fn evaluate<S: Senses>(
    code: &[Op],
    block: &Block,
    registers: &mut [f64],
    senses: &mut S,
    action: &mut Action,
) -> bool {
    let mut file = File(registers);
    let mut has_acted = false;
    // Jumps only go forward. An iterator over a slice needs no bounds check per operation.
    let code = &code[..block.end as usize];
    let mut ahead = code[block.start as usize..].iter();
    while let Some(&op) = ahead.next() {
        match op {
            Op::Copy { to, a } => file.put(to, file.at(a)),
            Op::CopyVector { to, a } => file.put_vector(to, file.vector(a)),
            Op::Add { to, a, b } => file.put(to, file.at(a) + file.at(b)),
            Op::Subtract { to, a, b } => file.put(to, file.at(a) - file.at(b)),
            Op::Multiply { to, a, b } => file.put(to, file.at(a) * file.at(b)),
            // `mul_add` would round only once and change results.
            Op::MultiplyAdd { to, a, b, c } => file.put(to, file.at(a) * file.at(b) + file.at(c)),
            Op::Divide { to, a, b } => file.put(to, file.at(a) / file.at(b)),
            Op::Negate { to, a } => file.put(to, -file.at(a)),
            Op::Absolute { to, a } => file.put(to, file.at(a).abs()),
            Op::Sign { to, a } => file.put(to, sign(file.at(a))),
            Op::SquareRoot { to, a } => file.put(to, file.at(a).sqrt()),
            Op::Minimum { to, a, b } => file.put(to, minimum(file.at(a), file.at(b))),
            Op::Maximum { to, a, b } => file.put(to, maximum(file.at(a), file.at(b))),
            Op::Clamp { to, a, low, high } => {
                file.put(to, minimum(maximum(file.at(a), file.at(low)), file.at(high)));
            }
            Op::Select { to, condition, a, b } => {
                file.put(to, if file.truth(condition) { file.at(a) } else { file.at(b) });
            }
            Op::Sine { to, a } => file.put(to, math::sin(file.at(a))),
            Op::Cosine { to, a } => file.put(to, math::cos(file.at(a))),
            Op::Exponential { to, a } => file.put(to, math::exp(file.at(a))),
            Op::Floor { to, a } => file.put(to, file.at(a).floor()),
            Op::Wrap { to, a } => file.put(to, wrap(file.at(a))),
            Op::Turn { to, a, b } => file.put(to, turn_between(file.at(a), file.at(b))),
            Op::Less { to, a, b } => file.put_truth(to, file.at(a) < file.at(b)),
            Op::LessOrEqual { to, a, b } => file.put_truth(to, file.at(a) <= file.at(b)),
            #[expect(clippy::float_cmp, reason = "the language's == is exact; it compares truths and whiskers")]
            Op::Equal { to, a, b } => file.put_truth(to, file.at(a) == file.at(b)),
            Op::And { to, a, b } => file.put_truth(to, file.truth(a) && file.truth(b)),
            Op::Or { to, a, b } => file.put_truth(to, file.truth(a) || file.truth(b)),
            Op::Not { to, a } => file.put_truth(to, !file.truth(a)),
            Op::AddVectors { to, a, b } => file.put_vector(to, file.vector(a) + file.vector(b)),
            Op::SubtractVectors { to, a, b } => file.put_vector(to, file.vector(a) - file.vector(b)),
            Op::NegateVector { to, a } => file.put_vector(to, -file.vector(a)),
            Op::MultiplyVector { to, a, b } => file.put_vector(to, file.vector(a) * file.at(b)),
            Op::DivideVector { to, a, b } => file.put_vector(to, file.vector(a) / file.at(b)),
            Op::Blend { to, a, b, share } => {
                let share = file.at(share);
                file.put_vector(to, file.vector(a) * (1.0 - share) + file.vector(b) * share);
            }
            Op::Distance { to, a, b } => file.put(to, (file.vector(a) - file.vector(b)).norm()),
            Op::Dot { to, a, b } => {
                let (a, b) = (file.vector(a), file.vector(b));
                file.put(to, a.x * b.x + a.y * b.y);
            }
            Op::Norm { to, a } => file.put(to, file.vector(a).norm()),
            Op::Unit { to, a } => file.put_vector(to, file.vector(a).try_normalize(0.0).unwrap_or_default()),
            Op::Angle { to, a } => {
                let vector = file.vector(a);
                file.put(to, math::atan2(vector.y, vector.x));
            }
            Op::Direction { to, a } => file.put_vector(to, direction(file.at(a))),
            Op::Rotate { to, a, b } => file.put_vector(to, rotate(file.vector(a), file.at(b))),
            Op::Time { to } => file.put(to, senses.time()),
            Op::Body { to, quantity } => file.put(to, senses.body(quantity)),
            Op::BodyPosition { to } => file.put_vector(to, senses.body_position()),
            Op::Whisker { to, whisker, quantity } => file.put(to, senses.whisker(file.index(whisker), quantity)),
            Op::WhiskerSize { to, whisker, quantity } => {
                file.put(to, senses.whisker(file.index(whisker), quantity).abs());
            }
            Op::WhiskerVector { to, whisker, quantity } => {
                file.put_vector(to, senses.whisker_vector(file.index(whisker), quantity));
            }
            Op::TipAt { to, whisker, a } => file.put_vector(to, senses.tip_at(file.index(whisker), file.at(a))),
            Op::LoopClosed { to, whisker, a, b } => {
                file.put_truth(to, senses.loop_closed(file.index(whisker), file.at(a), file.at(b)));
            }
            Op::ContourAt { to, contour, a, quantity } => {
                file.put_vector(to, senses.contour_at(file.index(contour), file.at(a), quantity));
            }
            Op::Map { to, quantity } => file.put(to, senses.map(quantity)),
            Op::MapVector { to, quantity } => file.put_vector(to, senses.map_vector(quantity)),
            Op::MapHolds { to, a, b, question } => {
                file.put_truth(to, senses.map_holds(question, file.vector(a), file.at(b)));
            }
            Op::LowPass { to, a, b, memory } => {
                let filtered = stateful::low_pass(file.memory(memory), senses.time(), file.at(a), file.at(b));
                let value = file.keep(memory, filtered);
                file.put(to, value);
            }
            Op::Pid { to, a, gains, memory } => {
                let gains = [0, 1, 2, 3].map(|gain| file.at(gains + gain));
                let output = stateful::pid(file.memory(memory), senses.time(), file.at(a), gains);
                let value = file.keep(memory, output);
                file.put(to, value);
            }
            Op::Count { to, counter } => {
                let count = file.at(counter) + 1.0;
                file.put(counter, count);
                file.put(to, count);
            }
            Op::Clear { memory, count } => (memory..memory + count).for_each(|register| file.put(register, 0.0)),
            Op::JumpUnless { a, target } => {
                if !file.truth(a) {
                    ahead = code[target as usize..].iter();
                }
            }
            Op::JumpUnlessLess { a, b, target } => {
                // With NaN the comparison is false, as for `<`. The negated operator would differ.
                let is_less = file.at(a) < file.at(b);
                if !is_less {
                    ahead = code[target as usize..].iter();
                }
            }
            Op::JumpUnlessBoth { a, b, target } => {
                if !(file.truth(a) && file.truth(b)) {
                    ahead = code[target as usize..].iter();
                }
            }
            Op::Jump { target } => ahead = code[target as usize..].iter(),
            Op::Record { whisker } => senses.record(file.index(whisker)),
            Op::RecordPosition { contour, a } => senses.record_position(usize::from(contour), file.vector(a)),
            Op::Mark { whisker, mark } => senses.mark(file.index(whisker), mark),
            Op::GoTo { a, b } => senses.go_to(file.vector(a), file.at(b)),
            Op::GiveUp => senses.give_up(),
            Op::Felt { a, b } => senses.felt(file.vector(a), file.vector(b)),
            Op::SteerBodyFacing { along, speed, heading } => {
                *action = file.steer(Mover::Body, along, speed, Turn::Facing(file.at(heading)));
                has_acted = true;
            }
            Op::SteerBodyTurning { along, speed, rate } => {
                *action = file.steer(Mover::Body, along, speed, Turn::Rate(file.at(rate)));
                has_acted = true;
            }
            Op::SteerWhiskerFacing { whisker, along, speed, heading } => {
                let mover = Mover::Whisker(file.index(whisker));
                *action = file.steer(mover, along, speed, Turn::Facing(file.at(heading)));
                has_acted = true;
            }
            Op::SteerWhiskerTurning { whisker, along, speed, rate } => {
                let mover = Mover::Whisker(file.index(whisker));
                *action = file.steer(mover, along, speed, Turn::Rate(file.at(rate)));
                has_acted = true;
            }
            Op::Hold => {
                *action = Action::Hold;
                has_acted = true;
            }
            Op::Stop => {
                *action = Action::Stop;
                has_acted = true;
            }
        }
    }
    has_acted
}

/// Executes code that gives no action.
pub fn compute<S: Senses>(code: &[Op], block: &Block, registers: &mut [f64], senses: &mut S) {
    evaluate(code, block, registers, senses, &mut Action::Hold);
}

/// The registers with typed access.
struct File<'a>(&'a mut [f64]);

impl File<'_> {
    /// The number in a register.
    fn at(&self, register: Register) -> f64 {
        self.0[usize::from(register)]
    }

    /// Writes a number.
    fn put(&mut self, register: Register, value: f64) {
        self.0[usize::from(register)] = value;
    }

    /// The memory of a stateful operation, from its first register on.
    fn memory<const N: usize>(&self, register: Register) -> [f64; N] {
        let start = usize::from(register);
        std::array::from_fn(|offset| self.0[start + offset])
    }

    /// Stores the memory of a stateful operation and returns its value.
    fn keep<const N: usize>(&mut self, register: Register, (memory, value): ([f64; N], f64)) -> f64 {
        let start = usize::from(register);
        self.0[start..start + N].copy_from_slice(&memory);
        value
    }

    /// The boolean in a register.
    fn truth(&self, register: Register) -> bool {
        self.at(register) > 0.5
    }

    /// Writes a boolean as 1 or 0.
    fn put_truth(&mut self, register: Register, truth: bool) {
        self.put(register, f64::from(u8::from(truth)));
    }

    /// The vector in two registers.
    fn vector(&self, register: Wide) -> Vector2 {
        Vector2::new(self.at(register), self.at(register + 1))
    }

    /// Writes a vector to two registers.
    fn put_vector(&mut self, register: Wide, vector: Vector2) {
        self.put(register, vector.x);
        self.put(register + 1, vector.y);
    }

    /// The index of a whisker in a register.
    fn index(&self, register: Register) -> usize {
        /// Added to a small whole number, this moves that number to the lowest bits.
        const UNIT_IN_LAST_PLACE: f64 = (1_u64 << (f64::MANTISSA_DIGITS - 1)) as f64;
        // A cast would be half of the cost of reading a whisker, because it handles every number. Indices are small
        // whole numbers.
        let [lowest, ..] = (self.at(register) + UNIT_IN_LAST_PLACE).to_le_bytes();
        usize::from(lowest)
    }

    /// Creates a steering action from registers.
    fn steer(&self, mover: Mover, along: Wide, speed: Register, turn: Turn) -> Action {
        Action::Steer { mover, along_world: self.vector(along), speed: self.at(speed), turn }
    }
}

/// The lesser of two numbers, or the second if they are equal, because zeros have signs. NaN if either is NaN, so that
/// an invalid sample is never hidden.
fn minimum(a: f64, b: f64) -> f64 {
    match a.partial_cmp(&b) {
        Some(Ordering::Less) => a,
        Some(_) => b,
        None => f64::NAN,
    }
}

/// The greater of two numbers, or the second if they are equal. NaN if either is NaN.
fn maximum(a: f64, b: f64) -> f64 {
    match a.partial_cmp(&b) {
        Some(Ordering::Greater) => a,
        Some(_) => b,
        None => f64::NAN,
    }
}

/// The unit vector with this direction. It is a separate function so that sine and cosine stay one call. Otherwise the
/// compiler merges each with those of other operations.
#[inline(never)]
fn direction(angle: f64) -> Vector2 {
    unit(angle)
}

/// The sign of a number: −1, 0 or 1. NaN for NaN.
fn sign(value: f64) -> f64 {
    if value == 0.0 { 0.0 } else { value.signum() }
}
