//! Ranges by property.

use std::collections::BTreeMap;

use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardUniform};

use vibrissa_declare::mismatch::Change;
use vibrissa_declare::rig::{Part, RigKey, key};

use super::{Difference, Property, Range};

/// The ranges of some properties.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Ranges(BTreeMap<Property, Range>);

impl Ranges {
    /// Sets the range of a property.
    pub fn set(&mut self, property: Property, range: impl Into<Range>) {
        self.0.insert(property, range.into());
    }

    /// The range of a property, if it is given.
    #[must_use]
    pub fn get(&self, property: Property) -> Option<Range> {
        self.0.get(&property).copied()
    }

    /// True if a range has a width, so that its value is drawn.
    #[must_use]
    pub fn are_drawn(&self) -> bool {
        self.0.values().any(|range| range.least < range.greatest)
    }

    /// Adds the ranges of `other` for properties that have none.
    pub(super) fn complete(&mut self, other: &Self) {
        for (&property, &range) in &other.0 {
            self.0.entry(property).or_insert(range);
        }
    }

    /// Draws a value for every property that has a range. The value of a property depends on its own range alone.
    pub(super) fn draw(&self, random: &mut ChaCha8Rng) -> Values {
        let mut values = Values::default();
        for difference in Difference::all() {
            let share: f64 = StandardUniform.sample(random);
            if let Some(range) = self.get(difference.property) {
                let value = if difference.is_logarithmic() { range.at_logarithm(share) } else { range.at(share) };
                values.0.insert(difference.property, value);
            }
        }
        values
    }

    /// The values at one end of every range, the least ones if `is_least` is true for the property.
    pub(super) fn extreme(&self, is_least: impl Fn(Property) -> bool) -> Values {
        let value = |(&property, range): (&Property, &Range)| {
            (property, if is_least(property) { range.least } else { range.greatest })
        };
        Values(self.0.iter().map(value).collect())
    }
}

/// The properties that change single keys of a rig.
pub(super) fn changes() -> impl Iterator<Item = (&'static RigKey, Change, Property)> {
    Difference::all().filter_map(|difference| {
        let (path, change) = difference.of?;
        Some((key(path)?, change, difference.property))
    })
}

/// The values of some properties.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Values(BTreeMap<Property, f64>);

impl Values {
    /// The value of a property, if it differs from the assumed one.
    pub(super) fn get(&self, property: Property) -> Option<f64> {
        self.0.get(&property).copied()
    }

    /// Applies the values that change single keys of this part of a rig.
    pub(super) fn apply<T: Part>(&self, part: &mut T) {
        for (key, change, property) in changes() {
            if let Some(value) = self.get(property) {
                key.apply(part, change, value);
            }
        }
    }

    /// The value of a property for which 0 means no difference.
    pub(super) fn or_zero(&self, property: Property) -> f64 {
        self.get(property).unwrap_or(0.0)
    }
}
