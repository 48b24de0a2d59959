//! The content of a model.

use vibrissa_runtime::rig::{Rig, Whisker};
use vibrissa_world::solid::Part;

/// The content of a model: its convex parts, its flexible whiskers, and its capacity for pairs.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Scope {
    /// The indices of the parts, counted over all solids, ascending.
    parts: Vec<usize>,
    /// For every whisker of the rig, true if it is a rigid part of the platform.
    rigid: Vec<bool>,
    /// The capacity for pairs that change during the run. `None` if all pairs are declared.
    capacity: Option<usize>,
}

impl Scope {
    /// The complete scene.
    #[must_use]
    pub fn whole(rig: &Rig, parts: &[Part]) -> Self {
        Self { parts: (0..parts.len()).collect(), rigid: vec![false; rig.whiskers.len()], capacity: None }
    }

    /// Replaces the parts, given by their indices, ascending.
    #[cfg(feature = "sim")]
    #[must_use]
    pub(crate) fn with_parts(self, parts: Vec<usize>) -> Self {
        Self { parts, ..self }
    }

    /// Sets a whisker, by its index in the rig, to rigid or flexible.
    #[cfg(feature = "sim")]
    #[must_use]
    pub(crate) fn with_rigid(mut self, whisker: usize, rigid: bool) -> Self {
        self.rigid[whisker] = rigid;
        self
    }

    /// Sets the capacity for pairs.
    #[must_use]
    pub fn with_capacity(self, pairs: usize) -> Self {
        Self { capacity: Some(pairs), ..self }
    }

    /// The capacity for pairs; `None` if all pairs are declared.
    #[must_use]
    pub(crate) fn capacity(&self) -> Option<usize> {
        self.capacity
    }

    /// The number of parts.
    #[cfg(all(test, feature = "sim"))]
    pub(crate) fn part_count(&self) -> usize {
        self.parts.len()
    }

    /// The position of a part, by its index, in the list of parts. `None` if it is not in the scope.
    #[must_use]
    pub(crate) fn rank_of_part(&self, index: usize) -> Option<usize> {
        self.parts.binary_search(&index).ok()
    }

    /// True if the part with this index is in the scope.
    #[must_use]
    pub(crate) fn has_part(&self, index: usize) -> bool {
        self.rank_of_part(index).is_some()
    }

    /// True if both scopes differ only in their rigid whiskers.
    #[cfg(feature = "sim")]
    #[must_use]
    pub(crate) fn is_like(&self, other: &Self) -> bool {
        self.parts == other.parts && self.capacity == other.capacity
    }

    /// True if a whisker, by its index in the rig, is rigid.
    #[must_use]
    pub(crate) fn is_rigid(&self, whisker: usize) -> bool {
        self.rigid[whisker]
    }

    /// The flexible whiskers with their indices in the rig.
    pub(crate) fn flexible<'r>(&self, rig: &'r Rig) -> impl Iterator<Item = (usize, &'r Whisker)> {
        rig.whiskers.iter().enumerate().filter(|(index, _)| !self.rigid[*index])
    }
}
