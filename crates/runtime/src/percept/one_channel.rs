//! The contact estimator `one_channel`.

use std::sync::Arc;

use crate::geometry::Pose;

use super::contact::Contact;
use super::contact_estimator::ContactEstimator;
use super::tip_curve::TipCurve;

/// Estimates the tip contact on a [`TipCurve`] from the base angle alone.
#[derive(Debug, Clone)]
pub(super) struct OneChannel {
    curve: Arc<TipCurve>,
    /// Standard deviation of the filtered base angle (rad).
    base_angle_deviation: f64,
    /// Length of the shaft (m).
    length: f64,
}

impl OneChannel {
    /// Creates the estimator of a whisker of `length` (m). `base_angle_deviation` (rad) is the standard deviation of
    /// the filtered base angle.
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
