//! The contact estimator `one_channel`.

use std::sync::Arc;

use crate::geometry::Pose;
use crate::rig::Sensing;

use super::contact::Contact;
use super::contact_estimator::ContactEstimator;
use super::tip_curve::TipCurve;
use super::whisker::filtered_deviation;

/// Estimates the tip contact on a [`TipCurve`] from the base angle alone.
#[derive(Debug, Clone)]
pub(super) struct OneChannel {
    curve: Arc<TipCurve>,
    /// Standard deviation of the filtered base angle (rad).
    base_angle_deviation: f64,
    sensing: Sensing,
    /// Length of the shaft (m).
    length: f64,
}

impl OneChannel {
    /// Creates the estimator of a whisker of `length` (m) with these sensors.
    pub(super) fn new(curve: Arc<TipCurve>, sensing: &Sensing, length: f64) -> Self {
        let base_angle_deviation = filtered_deviation(sensing, sensing.angle_noise);
        Self { curve, base_angle_deviation, sensing: sensing.clone(), length }
    }
}

impl ContactEstimator for OneChannel {
    fn set_noise(&mut self, noise: f64) {
        self.base_angle_deviation = filtered_deviation(&self.sensing, noise);
    }

    fn contact(&mut self, base_angle: f64, base: Pose) -> Option<Contact> {
        let covariance = self.curve.covariance(base_angle, self.base_angle_deviation)?;
        Some(Contact::by_tip(self.curve.contact_base(base_angle), &covariance, self.length, base))
    }
}
