//! Interval analysis: the possible results of a condition in a region.

use vibrissa_runtime::machine::{Block, Op, Register};

use super::interval::Interval;
use super::model::Model;
use super::region::Region;
use super::unknown::{Source, Unknown, scalar, vector};

/// An evaluator over intervals.
pub(super) struct Bounds<'m> {
    pub(super) model: &'m Model<'m>,
    /// The registers that the current code has written, each with the number of that evaluation.
    cells: Vec<(u32, Interval)>,
    evaluation: u32,
    /// Number of operations so far.
    pub(super) work: usize,
}

impl<'m> Bounds<'m> {
    pub(super) fn new(model: &'m Model<'m>) -> Self {
        Self {
            model,
            cells: vec![(0, Interval::ANYTHING); model.program.initial_registers.len()],
            evaluation: 0,
            work: 0,
        }
    }

    /// The interval of `register` after `code` in a region. `None` if the code has side effects.
    pub(super) fn value(&mut self, code: &Block, register: Register, region: &mut Region<'_>) -> Option<Interval> {
        self.evaluation += 1;
        self.work += code.len() + 1;
        let ops = self.model.program.code.get(code.start as usize..code.end as usize)?;
        for op in ops {
            if self.step(*op, region).is_none() {
                region.is_partial = true;
                return None;
            }
        }
        Some(self.at(register, region))
    }

    /// True if the current code has written a register.
    pub(super) fn is_written(&self, register: Register) -> bool {
        self.cells.get(usize::from(register)).is_some_and(|&(evaluation, _)| evaluation == self.evaluation)
    }

    /// The interval of a register that the current code has written.
    pub(super) fn cell(&self, register: Register) -> Interval {
        self.cells.get(usize::from(register)).map_or(Interval::ANYTHING, |&(_, value)| value)
    }

    /// The whisker or the contour to which a register refers, if it is only one.
    pub(super) fn whisker(&self, register: Register, region: &mut Region<'_>) -> Option<usize> {
        let mut whiskers = self.whiskers(register, region);
        whiskers.next().filter(|_| whiskers.next().is_none())
    }

    /// The interval of a register.
    pub(super) fn at(&self, register: Register, region: &mut Region<'_>) -> Interval {
        match self.cells.get(usize::from(register)) {
            Some(&(evaluation, value)) if evaluation == self.evaluation => value,
            _ => region.register(register),
        }
    }

    fn vector_at(&self, register: Register, region: &mut Region<'_>) -> [Interval; 2] {
        [self.at(register, region), self.at(register + 1, region)]
    }

    pub(super) fn put(&mut self, register: Register, value: Interval) {
        if let Some(cell) = self.cells.get_mut(usize::from(register)) {
            *cell = (self.evaluation, value);
        }
    }

    fn put_vector(&mut self, register: Register, [x, y]: [Interval; 2]) {
        self.put(register, x);
        self.put(register + 1, y);
    }

    /// Evaluates an operation. `None` if it has side effects.
    #[expect(clippy::too_many_lines, reason = "one arm an operation")]
    fn step(&mut self, op: Op, region: &mut Region<'_>) -> Option<()> {
        let mut one = |bounds: &mut Self, to, a, operation: fn(Interval) -> Interval| {
            let value = operation(bounds.at(a, region));
            bounds.put(to, value);
        };
        match op {
            Op::Copy { to, a } => one(self, to, a, |a| a),
            Op::Negate { to, a } => one(self, to, a, Interval::negate),
            Op::Absolute { to, a } => one(self, to, a, Interval::absolute),
            Op::Sign { to, a } => one(self, to, a, Interval::sign),
            Op::SquareRoot { to, a } => one(self, to, a, Interval::square_root),
            Op::Sine { to, a } => one(self, to, a, Interval::sine),
            Op::Cosine { to, a } => one(self, to, a, Interval::cosine),
            Op::Exponential { to, a } => one(self, to, a, Interval::exponential),
            Op::Floor { to, a } => one(self, to, a, Interval::floor),
            Op::Wrap { to, a } => one(self, to, a, Interval::wrapped),
            Op::Not { to, a } => one(self, to, a, Interval::not),
            Op::Add { .. }
            | Op::Subtract { .. }
            | Op::Multiply { .. }
            | Op::Divide { .. }
            | Op::Minimum { .. }
            | Op::Maximum { .. }
            | Op::Less { .. }
            | Op::LessOrEqual { .. }
            | Op::Equal { .. }
            | Op::And { .. }
            | Op::Or { .. } => self.two(op, region)?,
            Op::Clamp { .. }
            | Op::Blend { .. }
            | Op::Distance { .. }
            | Op::Dot { .. }
            | Op::Turn { .. }
            | Op::Select { .. }
            | Op::MultiplyAdd { .. } => {
                self.several(op, region)?;
            }
            Op::CopyVector { to, a } => {
                let value = self.vector_at(a, region);
                self.put_vector(to, value);
            }
            Op::Direction { to, a } => {
                let angle = self.at(a, region);
                self.put_vector(to, [angle.cosine(), angle.sine()]);
            }
            Op::AddVectors { to, a, b } => self.parts(to, (a, b), region, Interval::add),
            Op::SubtractVectors { to, a, b } => self.parts(to, (a, b), region, Interval::subtract),
            Op::NegateVector { to, a } => {
                let value = self.vector_at(a, region).map(Interval::negate);
                self.put_vector(to, value);
            }
            Op::MultiplyVector { to, a, b } => {
                let by = self.at(b, region);
                let value = self.vector_at(a, region).map(|part| part.multiply(by));
                self.put_vector(to, value);
            }
            Op::DivideVector { to, a, b } => {
                let by = self.at(b, region);
                let value = self.vector_at(a, region).map(|part| part.divide(by));
                self.put_vector(to, value);
            }
            Op::Norm { to, a } => {
                let value = Interval::norm(self.vector_at(a, region));
                self.put(to, value);
            }
            Op::Unit { to, a } => {
                let value = Interval::unit(self.vector_at(a, region));
                self.put_vector(to, value);
            }
            Op::Angle { to, a } => {
                let value = Interval::angle(self.vector_at(a, region));
                self.put(to, value);
            }
            Op::Rotate { to, a, b } => {
                let value = Interval::rotate(self.vector_at(a, region), self.at(b, region));
                self.put_vector(to, value);
            }
            Op::Time { to } => self.put(to, region.range(Unknown::Time)),
            Op::Body { to, quantity } => self.put(to, region.range(Unknown::Body(quantity))),
            Op::BodyPosition { to } => {
                self.put_vector(to, [0, 1].map(|axis| region.range(Unknown::BodyPosition(axis))));
            }
            Op::Whisker { to, whisker, quantity } => {
                let whiskers = self.whiskers(whisker, region);
                let values = whiskers.map(|whisker| scalar(region, whisker, quantity));
                let value = values.reduce(Interval::join).unwrap_or(Interval::ANYTHING);
                self.put(to, value);
            }
            Op::WhiskerSize { to, whisker, quantity } => {
                let whiskers = self.whiskers(whisker, region);
                let values = whiskers.map(|whisker| scalar(region, whisker, quantity));
                let value = values.reduce(Interval::join).unwrap_or(Interval::ANYTHING).absolute();
                self.put(to, value);
            }
            Op::WhiskerVector { to, whisker, quantity } => {
                let whiskers = self.whiskers(whisker, region);
                let values = whiskers.map(|whisker| vector(region, whisker, quantity));
                let value = values.reduce(|[x, y], [u, v]| [x.join(u), y.join(v)]).unwrap_or([Interval::ANYTHING; 2]);
                self.put_vector(to, value);
            }
            Op::LoopClosed { to, .. } => {
                // A loop depends on previous ticks.
                region.is_partial = true;
                self.put(to, Interval::new(0.0, 1.0));
            }
            Op::Map { to, quantity } => {
                // A map depends on previous ticks.
                region.is_partial = true;
                self.put(to, if quantity.is_bool() { Interval::new(0.0, 1.0) } else { Interval::ANYTHING });
            }
            Op::MapHolds { to, .. } => {
                region.is_partial = true;
                self.put(to, Interval::new(0.0, 1.0));
            }
            Op::TipAt { to, .. } | Op::ContourAt { to, .. } | Op::MapVector { to, .. } => {
                // The positions of tips depend on the rig's whiskers, the course of a contour on the object, and a map on previous
                // ticks.
                region.is_partial = true;
                self.put_vector(to, [Interval::ANYTHING; 2]);
            }
            Op::LowPass { to, .. } | Op::Pid { to, .. } | Op::Count { to, .. } => {
                // The results depend on previous ticks.
                region.is_partial = true;
                self.put(to, Interval::ANYTHING);
            }
            Op::Clear { .. }
            | Op::JumpUnless { .. }
            | Op::JumpUnlessLess { .. }
            | Op::JumpUnlessBoth { .. }
            | Op::Jump { .. }
            | Op::Record { .. }
            | Op::RecordPosition { .. }
            | Op::Mark { .. }
            | Op::GoTo { .. }
            | Op::GiveUp
            | Op::Felt { .. }
            | Op::SteerBodyFacing { .. }
            | Op::SteerBodyTurning { .. }
            | Op::SteerWhiskerFacing { .. }
            | Op::SteerWhiskerTurning { .. }
            | Op::Hold
            | Op::Stop => return None,
        }
        Some(())
    }

    /// Evaluates an operation on two vectors, component by component.
    fn parts(
        &mut self,
        to: Register,
        (a, b): (Register, Register),
        region: &mut Region<'_>,
        operation: fn(Interval, Interval) -> Interval,
    ) {
        let ([x, y], [u, v]) = (self.vector_at(a, region), self.vector_at(b, region));
        self.put_vector(to, [operation(x, u), operation(y, v)]);
    }

    /// Evaluates a fused operation. `None` for any other.
    fn several(&mut self, op: Op, region: &mut Region<'_>) -> Option<()> {
        match op {
            Op::Clamp { to, a, low, high } => {
                let raised = self.at(a, region).maximum(self.at(low, region));
                let value = raised.minimum(self.at(high, region));
                self.put(to, value);
            }
            Op::Select { to, condition, a, b } => {
                let (chosen, a, b) = (self.at(condition, region), self.at(a, region), self.at(b, region));
                let value = match (chosen.may_hold(), chosen.may_fail()) {
                    (true, true) => a.join(b),
                    (true, false) => a,
                    (false, _) => b,
                };
                self.put(to, value);
            }
            Op::Blend { to, a, b, share } => {
                let share = self.at(share, region);
                let rest = Interval::point(1.0).subtract(share);
                let ([x, y], [u, v]) = (self.vector_at(a, region), self.vector_at(b, region));
                let part = |from: Interval, into: Interval| from.multiply(rest).add(into.multiply(share));
                self.put_vector(to, [part(x, u), part(y, v)]);
            }
            Op::Distance { to, a, b } => {
                let ([x, y], [u, v]) = (self.vector_at(a, region), self.vector_at(b, region));
                self.put(to, Interval::norm([x.subtract(u), y.subtract(v)]));
            }
            Op::Dot { to, a, b } => {
                let ([x, y], [u, v]) = (self.vector_at(a, region), self.vector_at(b, region));
                self.put(to, x.multiply(u).add(y.multiply(v)));
            }
            Op::MultiplyAdd { to, a, b, c } => {
                let value = self.at(a, region).multiply(self.at(b, region)).add(self.at(c, region));
                self.put(to, value);
            }
            Op::Turn { to, a, b } => {
                let value = self.at(b, region).subtract(self.at(a, region)).wrapped();
                self.put(to, value);
            }
            _ => return None,
        }
        Some(())
    }

    /// Evaluates an operation on two numbers or bools. `None` for any other.
    fn two(&mut self, op: Op, region: &mut Region<'_>) -> Option<()> {
        let (to, a, b, operation): (_, _, _, fn(Interval, Interval) -> Interval) = match op {
            Op::Add { to, a, b } => (to, a, b, Interval::add),
            Op::Subtract { to, a, b } => (to, a, b, Interval::subtract),
            Op::Multiply { to, a, b } => (to, a, b, Interval::multiply),
            Op::Divide { to, a, b } => (to, a, b, Interval::divide),
            Op::Minimum { to, a, b } => (to, a, b, Interval::minimum),
            Op::Maximum { to, a, b } => (to, a, b, Interval::maximum),
            Op::Less { to, a, b } => (to, a, b, Interval::less),
            Op::LessOrEqual { to, a, b } => (to, a, b, Interval::less_or_equal),
            Op::Equal { to, a, b } => (to, a, b, Interval::equal),
            Op::And { to, a, b } => (to, a, b, Interval::and),
            Op::Or { to, a, b } => (to, a, b, Interval::or),
            _ => return None,
        };
        let value = operation(self.at(a, region), self.at(b, region));
        self.put(to, value);
        Some(())
    }

    /// The whiskers or contours to which a register can refer.
    fn whiskers(&self, register: Register, region: &mut Region<'_>) -> impl Iterator<Item = usize> + use<> {
        let range = self.at(register, region);
        let program = self.model.program;
        (0..program.whiskers.len() + program.contours.len())
            .filter(move |&index| (range.low..=range.high).contains(&(index as f64)))
    }
}
