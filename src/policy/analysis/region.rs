//! A region: what every unknown may be.

use vibrissa_runtime::machine::{BodyScalar, Register, WhiskerScalar, WhiskerVector};

use super::interval::Interval;
use super::model::Model;
use super::unknown::{Domain, Source, TOUCH, Unknown};

/// What every unknown may be that has been asked for so far.
#[derive(Clone)]
pub(super) struct Region<'m> {
    model: &'m Model<'m>,
    pub(super) parts: Vec<Part>,
    /// Whether something was asked for that no unknown stands for, so that no point of the region is the whole story.
    pub(super) is_partial: bool,
    /// The goals, by their index, that have nothing more to narrow, until a part changes that they read.
    settled: Vec<Option<Settled>>,
    /// The parts that were read since a goal began, and those of them that were changed.
    read: Parts,
    changed: Parts,
}

/// Some of the parts of a region, one bit each; those from the 128th on share the last.
type Parts = u128;

/// A goal that narrowed nothing: as long as nothing changes of what it read, it will not the next time either.
#[derive(Clone, Copy)]
struct Settled {
    read: Parts,
    /// Operations that it took to find out.
    work: usize,
}

/// One unknown in a region.
#[derive(Clone)]
pub(super) struct Part {
    pub(super) unknown: Unknown,
    pub(super) domain: Domain,
    /// How often it was split.
    splits: usize,
}

impl<'m> Region<'m> {
    /// All there can be.
    pub(super) fn whole(model: &'m Model<'m>) -> Self {
        Self { model, parts: Vec::new(), is_partial: false, settled: Vec::new(), read: 0, changed: 0 }
    }

    /// A goal begins to narrow, unless it is settled: then how many operations that would take.
    pub(super) fn begin(&mut self, goal: usize) -> Option<usize> {
        (self.read, self.changed) = (0, 0);
        self.settled.get(goal).copied().flatten().map(|settled| settled.work)
    }

    /// The goal that was begun has narrowed what it could, by so many operations.
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

    /// Some parts are no longer what they were.
    fn unsettle(&mut self, changed: Parts) {
        for settled in &mut self.settled {
            settled.take_if(|settled| settled.read & changed != 0);
        }
    }

    /// What a register holds that the code at hand has not written.
    pub(super) fn register(&mut self, register: Register) -> Interval {
        let unknown = Unknown::Register(register);
        if let Some(index) = self.parts.iter().position(|part| part.unknown == unknown) {
            self.read |= bit(index);
            return self.parts[index].domain.hull();
        }
        let Some(domain) = self.model.domain(register) else {
            let image = &self.model.program.image;
            return image.get(usize::from(register)).map_or(Interval::ANYTHING, |&value| Interval::point(value));
        };
        // What has no name could not be shown.
        self.is_partial |= self.model.named(register).is_none();
        let range = domain.hull();
        self.read |= bit(self.parts.len());
        self.parts.push(Part { unknown, domain, splits: 0 });
        range
    }

    /// Keeps of what an unknown may be only what `keep` keeps; false if that is nothing.
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

    /// Keeps of a register only what lies in an interval; false if nothing does.
    pub(super) fn narrow_register(&mut self, register: Register, to: Interval) -> bool {
        let is_possible = self.register(register).meet(to).has_any();
        is_possible && self.narrow(Unknown::Register(register), to)
    }

    /// Keeps of the time only what lies in an interval; false if nothing does.
    pub(super) fn narrow_time(&mut self, to: Interval) -> bool {
        self.narrow(Unknown::Time, to)
    }

    /// Keeps of a number of the body only what lies in an interval; false if nothing does.
    pub(super) fn narrow_body(&mut self, quantity: BodyScalar, to: Interval) -> bool {
        self.narrow(Unknown::Body(quantity), to)
    }

    /// Keeps of the body's place only what lies in an interval; false if nothing does.
    pub(super) fn narrow_position(&mut self, to: [Interval; 2]) -> bool {
        (0..2).all(|axis| self.narrow(Unknown::BodyPosition(axis), to[axis]))
    }

    /// Keeps of a whisker only what makes a number of it lie in an interval; false if nothing does.
    pub(super) fn narrow_scalar(&mut self, whisker: usize, quantity: WhiskerScalar, to: Interval) -> bool {
        match quantity {
            WhiskerScalar::Touching | WhiskerScalar::Side | WhiskerScalar::Sense => {
                self.keep(Unknown::Contact(whisker), |domain| domain.keep_contacts(quantity, to))
            }
            WhiskerScalar::Deflection => {
                // Of a whisker that touches only the magnitude counts here, and is at least that of a touch.
                let free = self.range(Unknown::Deflection(whisker));
                let size = to.absolute();
                let size = Interval {
                    low: if size.low <= TOUCH { 0.0 } else { size.low },
                    high: size.high.max(TOUCH),
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
            WhiskerScalar::Yaw | WhiskerScalar::Length | WhiskerScalar::TipSpread | WhiskerScalar::Fitted => {
                self.narrow(Unknown::Whisker(whisker, quantity), to)
            }
            WhiskerScalar::ContourCurvature => {
                // A number can only come of a contour.
                to.nan
                    || (self.keep(Unknown::Contour(whisker), Domain::keep_readable)
                        && self.narrow(Unknown::Whisker(whisker, quantity), to))
            }
        }
    }

    /// Keeps of a whisker only what makes a vector of it lie in intervals; false if nothing does.
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

    /// The region in two, along the unknown that has been split least; choices come before ranges. `None` if nothing
    /// can be split.
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
            self.parts.push(Part { unknown, domain: Domain::felt(unknown), splits: 0 });
            self.parts.len() - 1
        });
        self.read |= bit(index);
        &self.parts[index].domain
    }
}

fn bit(part: usize) -> Parts {
    1 << part.min(127)
}
