//! How much of a scene a model holds.

use crate::solid::Solid;
use vibrissa_runtime::rig::{Rig, Whisker};

/// How much of a scene a model holds: which convex parts are there, which whiskers bend, and what it looks for contacts of.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Scope {
    /// The parts of all solids, one after the other, by their indices, ascending.
    parts: Vec<usize>,
    /// Of every whisker of the rig, whether it is a rigid part of the platform.
    rigid: Vec<bool>,
    /// How many pairs of what may touch have room where they are named from time to time; elsewhere all are declared.
    room: Option<usize>,
}

impl Scope {
    /// Everything.
    #[must_use]
    pub fn whole(rig: &Rig, solids: &[Solid]) -> Self {
        let count = solids.iter().flat_map(Solid::parts).count();
        Self { parts: (0..count).collect(), rigid: vec![false; rig.whiskers.len()], room: None }
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

    /// The same, with room for so many pairs of what may touch.
    #[must_use]
    pub fn with_room(self, pairs: usize) -> Self {
        Self { room: Some(pairs), ..self }
    }

    /// How many pairs of what may touch have room; none where all are declared.
    #[must_use]
    pub fn room(&self) -> Option<usize> {
        self.room
    }

    /// How many parts there are.
    #[must_use]
    pub fn part_count(&self) -> usize {
        self.parts.len()
    }

    /// Where the part with this index comes among those that are there.
    #[must_use]
    pub fn rank_of_part(&self, index: usize) -> Option<usize> {
        self.parts.binary_search(&index).ok()
    }

    /// Whether the part with this index is there.
    #[must_use]
    pub fn has_part(&self, index: usize) -> bool {
        self.rank_of_part(index).is_some()
    }

    /// Whether both are alike but for what whiskers are rigid.
    #[must_use]
    pub fn is_like(&self, other: &Self) -> bool {
        self.parts == other.parts && self.room == other.room
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
