//! A region: what every unknown may be.

use crate::machine::Register;

use super::interval::Interval;
use super::model::Model;
use super::unknown::{Domain, Source, Unknown};

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
