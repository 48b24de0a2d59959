//! Backward interval analysis: from the wanted value of a condition to the domains of the unknowns.
//!
//! It removes only values for which the condition cannot have the wanted value.

use vibrissa_runtime::machine::{Op, Register};

use super::bounds::Bounds;
use super::interval::Interval;
use super::region::Region;
use super::search::{Goal, Wanted};

impl Bounds<'_> {
    /// Narrows a region to the points at which a goal may be met. False if there are none.
    pub(super) fn narrow(&mut self, goal: &Goal<'_>, region: &mut Region<'_>) -> bool {
        if let [only] = goal.any.as_slice() {
            return self.narrow_to(*only, region);
        }
        // If two alternatives are possible, neither is necessary.
        let mut possible = goal.any.iter().filter(|wanted| self.is_possible(**wanted, region).unwrap_or(true));
        match (possible.next().copied(), possible.next()) {
            (None, _) => false,
            (Some(last), None) => self.narrow_to(last, region),
            (Some(_), Some(_)) => true,
        }
    }

    /// True if a condition may be as wanted in a region. `None` if its code has side effects.
    fn is_possible(&mut self, wanted: Wanted<'_>, region: &mut Region<'_>) -> Option<bool> {
        let truth = self.value(wanted.condition.code, wanted.condition.truth, region)?;
        Some(if wanted.truth { truth.may_hold() } else { truth.may_fail() })
    }

    /// Narrows a region to the points at which a condition may be as wanted. False if there are none.
    fn narrow_to(&mut self, wanted: Wanted<'_>, region: &mut Region<'_>) -> bool {
        match self.is_possible(wanted, region) {
            None => return true,
            Some(false) => return false,
            Some(true) => {}
        }
        let code = wanted.condition.code;
        let ops = self.model.program.code.get(code.start as usize..code.end as usize).unwrap_or_default();
        self.work += ops.len();
        let truth = Interval::point(f64::from(u8::from(wanted.truth)));
        self.want(wanted.condition.truth, truth, region) && ops.iter().rev().all(|op| self.back(*op, region).is_some())
    }

    /// Restricts a register to an interval. False if nothing remains.
    fn want(&mut self, register: Register, wanted: Interval, region: &mut Region<'_>) -> bool {
        if !self.is_written(register) {
            return region.narrow_register(register, wanted);
        }
        let met = self.at(register, region).meet(wanted);
        self.put(register, met);
        met.has_any()
    }

    /// Propagates a result to the operands of an operation. `None` if no operands can give the result.
    fn back(&mut self, op: Op, region: &mut Region<'_>) -> Option<()> {
        let mut want = |bounds: &mut Self, register, wanted| bounds.want(register, wanted, region).then_some(());
        match op {
            Op::Copy { to, a } => {
                let result = self.cell(to);
                want(self, a, result)
            }
            Op::Less { .. } | Op::LessOrEqual { .. } | Op::Equal { .. } => self.back_comparison(op, region),
            Op::And { .. } | Op::Or { .. } | Op::Not { .. } => self.back_truth(op, region),
            Op::Select { to, condition, a, b } => self.back_choice(to, condition, [a, b], region),
            Op::Whisker { to, whisker, quantity } => {
                let result = self.cell(to);
                match self.whisker(whisker, region) {
                    Some(whisker) => region.narrow_scalar(whisker, quantity, result).then_some(()),
                    None => Some(()),
                }
            }
            Op::WhiskerVector { to, whisker, quantity } => {
                let result = [self.cell(to), self.cell(to + 1)];
                match self.whisker(whisker, region) {
                    Some(whisker) => region.narrow_vector(whisker, quantity, result).then_some(()),
                    None => Some(()),
                }
            }
            Op::Time { to } => region.narrow_time(self.cell(to)).then_some(()),
            Op::Body { to, quantity } => region.narrow_body(quantity, self.cell(to)).then_some(()),
            Op::BodyPosition { to } => region.narrow_position([self.cell(to), self.cell(to + 1)]).then_some(()),
            _ => self.back_number(op, region),
        }
    }

    fn back_comparison(&mut self, op: Op, region: &mut Region<'_>) -> Option<()> {
        let (Op::Less { to, a, b } | Op::LessOrEqual { to, a, b } | Op::Equal { to, a, b }) = op else {
            return Some(());
        };
        let (result, left, right) = (self.cell(to), self.at(a, region), self.at(b, region));
        let (up, down) = (|low| Interval::new(low, f64::INFINITY), |high| Interval::new(f64::NEG_INFINITY, high));
        let (left_wanted, right_wanted) = match op {
            Op::Equal { .. } if !result.may_fail() => (right.number(), left.number()),
            Op::Equal { .. } => return Some(()),
            _ if !result.may_fail() => (down(right.high), up(left.low)),
            _ if !result.may_hold() && !left.nan && !right.nan => (up(right.low), down(left.high)),
            _ => return Some(()),
        };
        (self.want(a, left_wanted, region) && self.want(b, right_wanted, region)).then_some(())
    }

    fn back_truth(&mut self, op: Op, region: &mut Region<'_>) -> Option<()> {
        let (yes, no) = (Interval::point(1.0), Interval::point(0.0));
        match op {
            Op::Not { to, a } => {
                let result = self.cell(to);
                let done = match (result.may_hold(), result.may_fail()) {
                    (true, true) => true,
                    (holds, _) => self.want(a, if holds { no } else { yes }, region),
                };
                done.then_some(())
            }
            Op::And { to, a, b } => {
                let (result, left, right) = (self.cell(to), self.at(a, region), self.at(b, region));
                let done = if !result.may_fail() {
                    self.want(a, yes, region) && self.want(b, yes, region)
                } else if result.may_hold() {
                    true
                } else {
                    (left.may_fail() || self.want(b, no, region)) && (right.may_fail() || self.want(a, no, region))
                };
                done.then_some(())
            }
            Op::Or { to, a, b } => {
                let (result, left, right) = (self.cell(to), self.at(a, region), self.at(b, region));
                let done = if !result.may_hold() {
                    self.want(a, no, region) && self.want(b, no, region)
                } else if result.may_fail() {
                    true
                } else {
                    (left.may_hold() || self.want(b, yes, region)) && (right.may_hold() || self.want(a, yes, region))
                };
                done.then_some(())
            }
            _ => Some(()),
        }
    }

    /// Propagates the result of a conditional expression to the side that gives it, if only one can.
    fn back_choice(
        &mut self,
        to: Register,
        condition: Register,
        [a, b]: [Register; 2],
        region: &mut Region<'_>,
    ) -> Option<()> {
        let (result, chosen) = (self.cell(to), self.at(condition, region));
        let fits = |side: Interval| side.meet(result).has_any();
        let is_first = chosen.may_hold() && fits(self.at(a, region));
        let is_second = chosen.may_fail() && fits(self.at(b, region));
        let (side, holds) = match (is_first, is_second) {
            (true, true) => return Some(()),
            (true, false) => (a, 1.0),
            (false, true) => (b, 0.0),
            (false, false) => return None,
        };
        (self.want(condition, Interval::point(holds), region) && self.want(side, result, region)).then_some(())
    }

    /// Propagates a result through arithmetic. A result that may be NaN gives no information.
    fn back_number(&mut self, op: Op, region: &mut Region<'_>) -> Option<()> {
        let mut wants: [Option<(Register, Interval)>; 2] = [None, None];
        match op {
            Op::Add { to, a, b } if !self.cell(to).nan => {
                let (sum, left, right) = (self.cell(to), self.at(a, region), self.at(b, region));
                wants = [Some((a, sum.undo(right, Interval::subtract))), Some((b, sum.undo(left, Interval::subtract)))];
            }
            Op::Subtract { to, a, b } if !self.cell(to).nan => {
                let (difference, left, right) = (self.cell(to), self.at(a, region), self.at(b, region));
                wants = [
                    Some((a, difference.undo(right, Interval::add))),
                    Some((b, difference.negate().undo(left, Interval::add))),
                ];
            }
            Op::Multiply { to, a, b } if !self.cell(to).nan => {
                let (product, left, right) = (self.cell(to), self.at(a, region), self.at(b, region));
                wants = [Some((a, product.undo_product(right))), Some((b, product.undo_product(left)))];
            }
            Op::Divide { to, a, b } if self.cell(to).is_finite() => {
                let (quotient, right) = (self.cell(to), self.at(b, region));
                wants = [Some((a, quotient.undo(right, Interval::multiply))), None];
            }
            Op::Negate { to, a } => wants = [Some((a, self.cell(to).negate())), None],
            Op::Absolute { to, a } => {
                let (size, value) = (self.cell(to), self.at(a, region));
                let both = size.negate().join(size);
                let side = if value.low >= 0.0 {
                    size
                } else if value.high <= 0.0 {
                    size.negate()
                } else {
                    both
                };
                wants = [Some((a, side)), None];
            }
            Op::Minimum { to, a, b } if !self.cell(to).nan => {
                let least = Interval::new(self.cell(to).low, f64::INFINITY);
                wants = [Some((a, least)), Some((b, least))];
            }
            Op::Maximum { to, a, b } if !self.cell(to).nan => {
                let most = Interval::new(f64::NEG_INFINITY, self.cell(to).high);
                wants = [Some((a, most)), Some((b, most))];
            }
            Op::Clamp { to, a, low, high } if !self.cell(to).nan => {
                let (clamped, low, high) = (self.cell(to), self.at(low, region), self.at(high, region));
                // The clamp is the identity except at its ends.
                let least = if clamped.low > low.high { clamped.low } else { f64::NEG_INFINITY };
                let most = if clamped.high < high.low { clamped.high } else { f64::INFINITY };
                wants = [Some((a, Interval::new(least, most))), None];
            }
            Op::Norm { to, a } if !self.cell(to).nan => {
                let size = self.cell(to).high;
                let part = Interval::new(-size, size).widened();
                wants = [Some((a, part)), Some((a + 1, part))];
            }
            _ => {}
        }
        wants.into_iter().flatten().all(|(register, wanted)| self.want(register, wanted, region)).then_some(())
    }
}
