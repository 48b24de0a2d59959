//! Contact estimators.

use std::fmt::Debug;

use crate::geometry::{Pose, Vector2};
use crate::signal::Reading;

use super::contact::Contact;

/// An estimate of where a whisker is touched, from its readings and the poses of its base.
///
/// A pose of the base is its place, and the direction of the undeflected shaft. A model that cannot tell says so, and never
/// goes on beyond its range. Nothing allocates.
pub trait ContactEstimator: Debug + Send + Sync + Boxed {
    /// Takes a reading, sampled with the base at `base`; base angle and pose are finite. A model that has no past needs none.
    fn take(&mut self, _reading: &Reading, _base: Pose) {}

    /// Forgets what is before a gap in the readings.
    fn interrupt(&mut self) {}

    /// Where the whisker is touched now, with the filtered base angle `base_angle` (rad) and the base at `base`. `None` if that
    /// cannot be told.
    fn contact(&mut self, base_angle: f64, base: Pose) -> Option<Contact>;

    /// Where a surface that goes as the one touched would be touched (m, frame of the base) at another deflection (rad), with the
    /// undeflected shaft in the direction `yaw` (rad). `None` if nothing is known of the surface, as by most models.
    fn contact_at(&self, _deflection: f64, _yaw: f64) -> Option<Vector2> {
        None
    }
}

/// What can be had once more: every tip model that can be cloned.
pub trait Boxed {
    /// The model once more.
    fn boxed(&self) -> Box<dyn ContactEstimator>;
}

impl<M: ContactEstimator + Clone + 'static> Boxed for M {
    fn boxed(&self) -> Box<dyn ContactEstimator> {
        Box::new(self.clone())
    }
}

impl Clone for Box<dyn ContactEstimator> {
    fn clone(&self) -> Self {
        self.as_ref().boxed()
    }
}
