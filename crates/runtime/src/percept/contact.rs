//! The contact of a whisker.

use nalgebra::{Matrix2, Rotation2};

use crate::geometry::{Point2, Pose, Vector2, rotate};

/// Where a whisker is touched, as a tip model estimates it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Contact {
    /// The place on the surface (m, world frame), not on the wire's axis.
    pub point_world: Point2,
    /// Covariance of the place (m², world frame).
    pub covariance_world: Matrix2<f64>,
    /// How far off the place may be (m), as a standard deviation: along the surface's normal if the model knows it, else either way.
    pub deviation: f64,
    /// The standard deviation (m) that goes into the record: `deviation` with those errors of the model that readings cannot tell.
    pub recorded_deviation: f64,
    /// Whether the place may be recorded. It may not while something else than the tip may touch.
    pub is_recordable: bool,
    /// Length of the shaft from its base to what touches (m): all of it for a tip.
    pub contact_length: f64,
}

impl Contact {
    /// A touch by the tip of a whisker of `length` (m) at `position` with its `covariance` (m, m²; frame of the base), with the base at
    /// `base`, where nothing is known of the surface's direction.
    pub(super) fn by_tip(position: Vector2, covariance: &Matrix2<f64>, length: f64, base: Pose) -> Self {
        let deviation = covariance.trace().sqrt();
        Self {
            point_world: base.position + rotate(position, base.heading),
            covariance_world: turned(covariance, base.heading),
            deviation,
            recorded_deviation: deviation,
            is_recordable: true,
            contact_length: length,
        }
    }
}

/// How far a surface may be from where the mechanics have it (m), as a standard deviation: contacts are a little soft, and a tip that
/// slides drags. A whole scene may be off to the same side by this.
pub(super) const CONTACT_DEVIATION: f64 = 2.2e-5;

/// A covariance in a frame that is turned back by an angle (rad).
pub(super) fn turned(covariance: &Matrix2<f64>, angle: f64) -> Matrix2<f64> {
    let turn = Rotation2::new(angle);
    turn * covariance * turn.inverse()
}
