//! Coulomb friction of a contact.
//!
//! Why: docs/decisions/quasi-static.md#quasi-static-friction-is-an-active-set-of-cone-edges.

use crate::geometry::{Point2, Vector2};

/// An edge of the friction cone. The force along it is the normal plus or minus the coefficient of friction times the
/// tangent, where the tangent is to the left of the normal.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Edge {
    /// The friction acts along the tangent. Without friction, this is the only edge.
    Left,
    /// The friction acts against the tangent.
    Right,
}

/// A contact force, as multiples of both edges of the friction cone. A whisker slides under a force along one edge. It
/// sticks under a force between the edges.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct ConeForce {
    left: f64,
    right: f64,
}

/// The state of a contact from which its slip is measured.
#[derive(Debug, Clone, Copy)]
pub(super) struct Anchor {
    /// The end of the link (m, world frame). For the side of a link, the point or the centre of the arc that it touches.
    pub(super) place: Point2,
    /// The position of the contact on the link (m from the near end).
    pub(super) along: f64,
    /// The direction of the link (rad, world frame).
    pub(super) angle: f64,
}

impl Edge {
    pub(super) const BOTH: [Self; 2] = [Self::Left, Self::Right];

    /// +1 if friction acts along the tangent, and −1 if it acts against it.
    pub(super) fn sign(self) -> f64 {
        match self {
            Self::Left => 1.0,
            Self::Right => -1.0,
        }
    }

    pub(super) fn opposite(self) -> Self {
        match self {
            Self::Left => Self::Right,
            Self::Right => Self::Left,
        }
    }
}

impl ConeForce {
    /// The normal component of the force (N).
    pub(super) fn normal(self) -> f64 {
        self.left + self.right
    }

    /// The component of the force along the tangent (N), for a coefficient of friction.
    pub(super) fn tangential(self, friction: f64) -> f64 {
        friction * (self.left - self.right)
    }

    /// True if there is a force.
    pub(super) fn acts(self) -> bool {
        self.normal() > 0.0
    }

    /// True if the contact sticks.
    pub(super) fn sticks(self) -> bool {
        self.left > 0.0 && self.right > 0.0
    }

    /// True if there is a force along an edge.
    pub(super) fn acts_along(self, edge: Edge) -> bool {
        match edge {
            Edge::Left => self.left > 0.0,
            Edge::Right => self.right > 0.0,
        }
    }

    /// Adds a force along an edge (N).
    pub(super) fn add(&mut self, edge: Edge, force: f64) {
        match edge {
            Edge::Left => self.left += force,
            Edge::Right => self.right += force,
        }
    }
}

impl Anchor {
    /// Returns the slip (m) from this state to `now` along a tangent of the surface. A link that rolls on the surface
    /// does not slip. `rolling` is the slip per rotation (m/rad) of a link whose contact does not move along it.
    pub(super) fn slip(&self, now: &Self, tangent: Vector2, link: Vector2, rolling: f64) -> f64 {
        let along = (self.along - now.along) * link.dot(&tangent);
        (now.place - self.place).dot(&tangent) + along + rolling * (now.angle - self.angle)
    }
}
