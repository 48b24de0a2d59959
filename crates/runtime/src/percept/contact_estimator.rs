//! The trait of contact estimators.

use std::fmt::Debug;

use crate::geometry::{Pose, Vector2};
use crate::signal::Reading;

use super::contact::Contact;
use super::pose_delay::Misfit;

/// An estimator of the contact position of a whisker from its readings and the poses of its base.
///
/// The heading of a pose of the base is the direction of the undeflected shaft. Outside of its range an estimator
/// returns `None`. It never extrapolates. No method allocates memory.
pub trait ContactEstimator: Debug + Send + Sync + Boxed {
    /// Adds a reading, sampled with the base at `base`. Base angle and pose are finite. The default, for estimators
    /// without memory, does nothing.
    fn take(&mut self, _reading: &Reading, _base: Pose) {}

    /// The misfit of the newest reading with the contact that was expected. `None` without an expectation, which is the
    /// default.
    fn misfit(&self) -> Option<Misfit> {
        None
    }

    /// Forgets earlier readings at a gap. The default does nothing.
    fn interrupt(&mut self) {}

    /// Sets the standard deviation (rad) of the noise of a base angle in each reading. It is called when a whisker in
    /// free air has another noise than the rig states. The default, for estimators without uncertainty, does nothing.
    fn set_noise(&mut self, _noise: f64) {}

    /// Sets the standard deviation (rad) of the offset of the readings, which grows while the whisker touches. The default, for
    /// estimators without uncertainty, does nothing.
    fn set_offset_deviation(&mut self, _deviation: f64) {}

    /// Returns the current contact for the filtered base angle `base_angle` (rad) and the pose `base` of the base, or
    /// `None` if it cannot be estimated.
    fn contact(&mut self, base_angle: f64, base: Pose) -> Option<Contact>;

    /// Returns the contact position (m, frame of the base) at another base angle (rad) on a surface with the same
    /// direction. `yaw` (rad) is the direction of the undeflected shaft. `None` if the direction of the surface is
    /// unknown, which is the default.
    fn contact_at(&self, _deflection: f64, _yaw: f64) -> Option<Vector2> {
        None
    }
}

/// Cloning of boxed estimators. Every estimator that implements [`Clone`] has it.
pub trait Boxed {
    /// Returns a boxed clone.
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
