//! A region: what every unknown may be.

use crate::machine::{BodyScalar, Register, WhiskerScalar, WhiskerVector};

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
        Self { model, parts: Vec::new(), is_partial: false }
    }

    /// What a register holds that the code at hand has not written.
    pub(super) fn register(&mut self, register: Register) -> Interval {
        let unknown = Unknown::Register(register);
        if let Some(part) = self.parts.iter().find(|part| part.unknown == unknown) {
            return part.domain.hull();
        }
        let Some(domain) = self.model.domain(register) else {
            let image = &self.model.program.image;
            return image.get(usize::from(register)).map_or(Interval::ANYTHING, |&value| Interval::point(value));
        };
        // What has no name could not be shown.
        self.is_partial |= self.model.named(register).is_none();
        let range = domain.hull();
        self.parts.push(Part { unknown, domain, splits: 0 });
        range
    }

    /// Keeps of what an unknown may be only what `keep` keeps; false if that is nothing.
    fn keep(&mut self, unknown: Unknown, keep: impl FnOnce(&mut Domain) -> bool) -> bool {
        let Some(part) = self.parts.iter_mut().find(|part| part.unknown == unknown) else { return true };
        keep(&mut part.domain)
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
            WhiskerScalar::ContourReady => self.narrow(Unknown::Ready(whisker), to),
            WhiskerScalar::Yaw | WhiskerScalar::Length | WhiskerScalar::TipSpread => {
                self.narrow(Unknown::Whisker(whisker, quantity), to)
            }
            WhiskerScalar::ContourCurvature => {
                // A number can only come of a contour that is ready.
                to.nan
                    || (self.narrow(Unknown::Ready(whisker), Interval::point(1.0))
                        && self.narrow(Unknown::Whisker(whisker, quantity), to))
            }
        }
    }

    /// Keeps of a whisker only what makes a vector of it lie in intervals; false if nothing does.
    pub(super) fn narrow_vector(&mut self, whisker: usize, quantity: WhiskerVector, to: [Interval; 2]) -> bool {
        match quantity {
            WhiskerVector::ContourTangent | WhiskerVector::ContourNormal => {
                to.iter().all(|to| to.nan) || self.narrow(Unknown::Ready(whisker), Interval::point(1.0))
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
        &self.parts[index].domain
    }
}
