//! The tip model of one channel: the base angle alone.

use std::sync::Arc;

use crate::geometry::Pose;

use super::contact::Contact;
use super::contact_estimator::ContactEstimator;
use super::tip_curve::TipCurve;

/// Takes the tip to be on a [`TipCurve`].
#[derive(Debug, Clone)]
pub(super) struct OneChannel {
    curve: Arc<TipCurve>,
    /// Standard deviation of the deflection (rad).
    base_angle_deviation: f64,
    length: f64,
}

impl OneChannel {
    /// The model of a whisker of `length` (m) whose deflection may be off by `base_angle_deviation` (rad).
    pub(super) fn new(curve: Arc<TipCurve>, base_angle_deviation: f64, length: f64) -> Self {
        Self { curve, base_angle_deviation, length }
    }
}

impl ContactEstimator for OneChannel {
    fn contact(&mut self, base_angle: f64, base: Pose) -> Option<Contact> {
        let covariance = self.curve.covariance(base_angle, self.base_angle_deviation)?;
        Some(Contact::by_tip(self.curve.contact_base(base_angle), &covariance, self.length, base))
    }
}
