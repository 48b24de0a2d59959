//! The active set of contacts in a step.

use super::contact::Contact;
use super::friction::Edge;

/// The active edges, and the curvatures of their gaps.
#[derive(Debug, Default)]
pub(super) struct ActiveSet {
    pub(super) edges: Vec<Active>,
    pub(super) curvatures: Vec<CurvatureColumn>,
}

/// An active edge of a contact.
#[derive(Debug, Clone, Copy)]
pub(super) struct Active {
    /// The index of the contact.
    pub(super) contact: usize,
    pub(super) edge: Edge,
    /// The multiple of the edge in the contact force (N).
    pub(super) force: f64,
    /// The generalised force of the edge.
    pub(super) push: Weighted,
}

/// A border column plus a multiple of another one.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Weighted {
    pub(super) column: usize,
    pub(super) other: usize,
    pub(super) share: f64,
}

/// A border column for the curvature of a gap.
#[derive(Debug, Clone, Copy)]
pub(super) struct CurvatureColumn {
    pub(super) column: usize,
    /// The generalised force by which the curvature acts: the same column, and with friction a multiple of the normal.
    pub(super) push: Weighted,
    /// The column with which it forms a product; itself for a square.
    pub(super) partner: usize,
    /// The inverse of the coefficient of this product.
    pub(super) inverse: f64,
}

impl Weighted {
    pub(super) fn terms(self) -> impl Iterator<Item = (usize, f64)> {
        std::iter::once((self.column, 1.0)).chain((self.share != 0.0).then_some((self.other, self.share)))
    }
}

/// Returns the direction in which an active edge holds the contact, and its gap (m) in this direction. A contact that
/// slides is held along the normal. One that sticks is held along both edges.
pub(super) fn held(active: &[Active], edge: &Active, contacts: &[Contact]) -> (Weighted, f64) {
    let contact = &contacts[edge.contact];
    let sticks = active.iter().any(|other| other.contact == edge.contact && other.edge != edge.edge);
    let share = if sticks { edge.push.share } else { 0.0 };
    (Weighted { share, ..edge.push }, contact.gap + share * contact.slip)
}
