//! Tip models: estimates of where a whisker is touched.

use std::fmt::Debug;

use nalgebra::{Matrix2, Rotation2};

use crate::geometry::{Point2, Pose, Vector2, rotate};
use crate::signal::Reading;

/// Where a whisker is touched, as a tip model estimates it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Touch {
    /// The place on the surface (m, world frame), not on the wire's axis.
    pub point_world: Point2,
    /// Covariance of the place (m², world frame).
    pub covariance_world: Matrix2<f64>,
    /// How far off the place may be (m), as a standard deviation: along the surface's normal if the model knows it, else either way.
    pub spread: f64,
    /// The standard deviation (m) that goes into the record: `spread` with those errors of the model that readings cannot tell.
    pub recorded_spread: f64,
    /// Whether the place may be recorded. It may not while something else than the tip may touch.
    pub is_sure: bool,
    /// Length of the shaft from its base to what touches (m): all of it for a tip.
    pub contact_length: f64,
}

impl Touch {
    /// A touch by the tip of a whisker of `length` (m) at `place` with its `covariance` (m, m²; frame of the base), with the base at
    /// `base`, where nothing is known of the surface's direction.
    pub(super) fn by_tip(place: Vector2, covariance: &Matrix2<f64>, length: f64, base: Pose) -> Self {
        let spread = covariance.trace().sqrt();
        Self {
            point_world: base.position + rotate(place, base.heading),
            covariance_world: turned(covariance, base.heading),
            spread,
            recorded_spread: spread,
            is_sure: true,
            contact_length: length,
        }
    }
}

/// An estimate of where a whisker is touched, from its readings and the poses of its base.
///
/// A pose of the base is its place, and the direction of the undeflected shaft. A model that cannot tell says so, and never
/// goes on beyond its range. Nothing allocates.
pub trait TipModel: Debug + Send + Sync + Boxed {
    /// Takes a reading, sampled with the base at `base`; base angle and pose are finite. A model that has no past needs none.
    fn take(&mut self, _reading: &Reading, _base: Pose) {}

    /// Forgets what is before a gap in the readings.
    fn interrupt(&mut self) {}

    /// Where the whisker is touched now, with the filtered base angle `deflection` (rad) and the base at `base`. `None` if that
    /// cannot be told.
    fn touch(&mut self, deflection: f64, base: Pose) -> Option<Touch>;

    /// Where a surface that goes as the one touched would be touched (m, frame of the base) at another deflection (rad), with the
    /// undeflected shaft in the direction `yaw` (rad). `None` if nothing is known of the surface, as by most models.
    fn touch_at(&self, _deflection: f64, _yaw: f64) -> Option<Vector2> {
        None
    }
}

/// What can be had once more: every tip model that can be cloned.
pub trait Boxed {
    /// The model once more.
    fn boxed(&self) -> Box<dyn TipModel>;
}

impl<M: TipModel + Clone + 'static> Boxed for M {
    fn boxed(&self) -> Box<dyn TipModel> {
        Box::new(self.clone())
    }
}

impl Clone for Box<dyn TipModel> {
    fn clone(&self) -> Self {
        self.as_ref().boxed()
    }
}

/// How far a surface may be from where the mechanics have it (m), as a standard deviation: contacts are a little soft, and a tip that
/// slides drags. A whole scene may be off to the same side by this.
pub(super) const CONTACT_SPREAD: f64 = 2.2e-5;

/// A covariance in a frame that is turned back by an angle (rad).
pub(super) fn turned(covariance: &Matrix2<f64>, angle: f64) -> Matrix2<f64> {
    let turn = Rotation2::new(angle);
    turn * covariance * turn.inverse()
}
