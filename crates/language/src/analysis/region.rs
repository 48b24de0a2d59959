//! Regions: a domain for every unknown.

use vibrissa_runtime::machine::{BodyScalar, Register, WhiskerScalar, WhiskerVector};

use super::interval::Interval;
use super::model::Model;
use super::unknown::{Domain, MIN_CONTACT_ANGLE, Source, Unknown};

/// The domains of all unknowns that have been read so far.
#[derive(Clone)]
pub(super) struct Region<'m> {
    model: &'m Model<'m>,
    pub(super) parts: Vec<Part>,
    /// True if an input was read that no unknown represents. A point of the region then does not determine the result.
    pub(super) is_partial: bool,
    /// For each goal, its state if it cannot narrow the region further until a part that it reads changes.
    settled: Vec<Option<Settled>>,
    /// The parts that were read since the current goal began, and those that were changed.
    read: Parts,
    changed: Parts,
}

/// A set of parts of a region, one bit each. Parts from the 128th on share the last bit.
type Parts = u128;

/// A goal that narrowed nothing. While its inputs do not change, it will not narrow anything again.
#[derive(Clone, Copy)]
struct Settled {
    read: Parts,
    /// Number of operations of the evaluation.
    work: usize,
}

/// One unknown of a region with its domain.
#[derive(Clone)]
pub(super) struct Part {
    pub(super) unknown: Unknown,
    pub(super) domain: Domain,
    /// Number of splits.
    splits: usize,
}

impl<'m> Region<'m> {
    /// The region of all possible values.
    pub(super) fn whole(model: &'m Model<'m>) -> Self {
        Self { model, parts: Vec::new(), is_partial: false, settled: Vec::new(), read: 0, changed: 0 }
    }

    /// Begins the narrowing by a goal. If the goal is settled, returns the number of operations that the narrowing
    /// would take.
    pub(super) fn begin(&mut self, goal: usize) -> Option<usize> {
        (self.read, self.changed) = (0, 0);
        self.settled.get(goal).copied().flatten().map(|settled| settled.work)
    }

    /// Ends the narrowing by the current goal, which took so many operations.
    pub(super) fn end(&mut self, goal: usize, work: usize) {
        if self.changed != 0 {
            self.unsettle(self.changed);
            return;
        }
        if self.settled.len() <= goal {
            self.settled.resize(goal + 1, None);
        }
        self.settled[goal] = Some(Settled { read: self.read, work });
    }

    /// Marks goals as unsettled that read changed parts.
    fn unsettle(&mut self, changed: Parts) {
        for settled in &mut self.settled {
            settled.take_if(|settled| settled.read & changed != 0);
        }
    }

    /// The interval of a register that the current code has not written.
    pub(super) fn register(&mut self, register: Register) -> Interval {
        let unknown = Unknown::Register(register);
        if let Some(index) = self.parts.iter().position(|part| part.unknown == unknown) {
            self.read |= bit(index);
            return self.parts[index].domain.hull();
        }
        let Some(domain) = self.model.domain(register) else {
            let image = &self.model.program.initial_registers;
            return image.get(usize::from(register)).map_or(Interval::ANYTHING, |&value| Interval::point(value));
        };
        // An unnamed value could not be shown in a message.
        self.is_partial |= self.model.named(register).is_none();
        let range = domain.hull();
        self.read |= bit(self.parts.len());
        self.parts.push(Part { unknown, domain, splits: 0 });
        range
    }

    /// Restricts the domain of an unknown by `keep`. False if it becomes empty.
    fn keep(&mut self, unknown: Unknown, keep: impl FnOnce(&mut Domain) -> bool) -> bool {
        let Some(index) = self.parts.iter().position(|part| part.unknown == unknown) else { return true };
        let domain = &mut self.parts[index].domain;
        let before = domain.extent();
        let has_any = keep(domain);
        self.read |= bit(index);
        if domain.extent() != before {
            self.changed |= bit(index);
        }
        has_any
    }

    fn narrow(&mut self, unknown: Unknown, to: Interval) -> bool {
        self.keep(unknown, |domain| domain.narrow(to))
    }

    /// Restricts a register to an interval. False if nothing remains.
    pub(super) fn narrow_register(&mut self, register: Register, to: Interval) -> bool {
        let is_possible = self.register(register).meet(to).has_any();
        is_possible && self.narrow(Unknown::Register(register), to)
    }

    /// Restricts the time to an interval. False if nothing remains.
    pub(super) fn narrow_time(&mut self, to: Interval) -> bool {
        self.narrow(Unknown::Time, to)
    }

    /// Restricts a scalar of the body to an interval. False if nothing remains.
    pub(super) fn narrow_body(&mut self, quantity: BodyScalar, to: Interval) -> bool {
        self.narrow(Unknown::Body(quantity), to)
    }

    /// Restricts the body's position to intervals. False if nothing remains.
    pub(super) fn narrow_position(&mut self, to: [Interval; 2]) -> bool {
        (0..2).all(|axis| self.narrow(Unknown::BodyPosition(axis), to[axis]))
    }

    /// Restricts the unknowns of a whisker so that its scalar lies in an interval. False if nothing remains.
    pub(super) fn narrow_scalar(&mut self, whisker: usize, quantity: WhiskerScalar, to: Interval) -> bool {
        match quantity {
            WhiskerScalar::Touching | WhiskerScalar::Side | WhiskerScalar::Sense => {
                self.keep(Unknown::Contact(whisker), |domain| domain.keep_contacts(quantity, to))
            }
            WhiskerScalar::BaseAngle => {
                // Of a whisker that touches only the magnitude counts here, and is at least that of a touch.
                let free = self.range(Unknown::Deflection(whisker));
                let size = to.absolute();
                let size = Interval {
                    low: if size.low <= MIN_CONTACT_ANGLE { 0.0 } else { size.low },
                    high: size.high.max(MIN_CONTACT_ANGLE),
                    nan: true,
                };
                let side = if free.low >= 0.0 {
                    size
                } else if free.high <= 0.0 {
                    size.negate()
                } else {
                    size.join(size.negate())
                };
                self.narrow(Unknown::Deflection(whisker), side)
            }
            WhiskerScalar::ContourReady => self.keep(Unknown::Contour(whisker), |domain| domain.keep_ready(to)),
            WhiskerScalar::Yaw
            | WhiskerScalar::Length
            | WhiskerScalar::TipDeviation
            | WhiskerScalar::BaseAngleDeviation
            | WhiskerScalar::RecordedDeviation
            | WhiskerScalar::Fitted => self.narrow(Unknown::Whisker(whisker, quantity), to),
            WhiskerScalar::ContourCurvature => {
                // Only a contour can give a number.
                to.nan
                    || (self.keep(Unknown::Contour(whisker), Domain::keep_readable)
                        && self.narrow(Unknown::Whisker(whisker, quantity), to))
            }
        }
    }

    /// Restricts the unknowns of a whisker so that its vector lies in intervals. False if nothing remains.
    pub(super) fn narrow_vector(&mut self, whisker: usize, quantity: WhiskerVector, to: [Interval; 2]) -> bool {
        match quantity {
            WhiskerVector::ContourTangent | WhiskerVector::ContourNormal => {
                to.iter().all(|to| to.nan) || self.keep(Unknown::Contour(whisker), Domain::keep_readable)
            }
            WhiskerVector::ContourEnd | WhiskerVector::Tip | WhiskerVector::TipBase | WhiskerVector::Base => {
                let part = |axis| Unknown::WhiskerVector(whisker, quantity, axis);
                (0..2).all(|axis| to[axis].nan || self.narrow(part(axis), to[axis]))
            }
        }
    }

    /// Splits the region in two, along the unknown with the fewest splits. Discrete domains come before ranges. `None`
    /// if nothing can be split.
    pub(super) fn split(&self) -> Option<[Self; 2]> {
        let rank = |part: &Part| (matches!(part.domain, Domain::Range(_)), part.splits);
        let mut order: Vec<usize> = (0..self.parts.len()).collect();
        order.sort_by_key(|&index| rank(&self.parts[index]));
        let (index, halves) = order.into_iter().find_map(|index| Some((index, self.parts[index].domain.split()?)))?;
        Some(halves.map(|domain| {
            let mut half = self.clone();
            half.parts[index].domain = domain;
            half.parts[index].splits += 1;
            half.unsettle(bit(index));
            half
        }))
    }
}

impl Source for Region<'_> {
    fn domain(&mut self, unknown: Unknown) -> &Domain {
        let known = self.parts.iter().position(|part| part.unknown == unknown);
        let index = known.unwrap_or_else(|| {
            self.parts.push(Part { unknown, domain: Domain::possible(unknown), splits: 0 });
            self.parts.len() - 1
        });
        self.read |= bit(index);
        &self.parts[index].domain
    }
}

fn bit(part: usize) -> Parts {
    1 << part.min(127)
}
