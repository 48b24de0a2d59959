//! How much of a scene a model holds.

use crate::rig::{Rig, Whisker};
use crate::scene::Solid;

/// How much of a scene a model holds: which convex parts are there, and which whiskers bend.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Scope {
    /// The parts of all solids, one after the other, by their indices, ascending.
    parts: Vec<usize>,
    /// Of every whisker of the rig, whether it is a rigid part of the platform.
    rigid: Vec<bool>,
}

impl Scope {
    /// Everything.
    #[must_use]
    pub fn whole(rig: &Rig, solids: &[Solid]) -> Self {
        let count = solids.iter().flat_map(Solid::parts).count();
        Self { parts: (0..count).collect(), rigid: vec![false; rig.whiskers.len()] }
    }

    /// The same whiskers before these parts, given by their indices, ascending.
    #[must_use]
    pub fn with_parts(self, parts: Vec<usize>) -> Self {
        Self { parts, ..self }
    }

    /// The same parts, with a whisker (by its index in the rig) that is rigid or bends.
    #[must_use]
    pub fn with_rigid(mut self, whisker: usize, rigid: bool) -> Self {
        self.rigid[whisker] = rigid;
        self
    }

    /// How many parts there are.
    #[must_use]
    pub fn part_count(&self) -> usize {
        self.parts.len()
    }

    /// Whether the part with this index is there.
    #[must_use]
    pub fn has_part(&self, index: usize) -> bool {
        self.parts.binary_search(&index).is_ok()
    }

    /// Whether both have the same parts.
    #[must_use]
    pub fn has_parts_of(&self, other: &Self) -> bool {
        self.parts == other.parts
    }

    /// Whether a whisker, by its index in the rig, is a rigid part of the platform.
    #[must_use]
    pub fn is_rigid(&self, whisker: usize) -> bool {
        self.rigid[whisker]
    }

    /// The whiskers that bend, with their indices in the rig.
    pub fn flexible<'r>(&self, rig: &'r Rig) -> impl Iterator<Item = (usize, &'r Whisker)> {
        rig.whiskers.iter().enumerate().filter(|(index, _)| !self.rigid[*index])
    }
}
