//! The tip model of one channel: the base angle alone.

use std::sync::Arc;

use crate::geometry::Pose;

use super::tip_curve::TipCurve;
use super::tip_model::{TipModel, Touch};

/// Takes the tip to be on a [`TipCurve`].
#[derive(Debug, Clone)]
pub(super) struct OneChannel {
    curve: Arc<TipCurve>,
    /// Standard deviation of the deflection (rad).
    deflection_spread: f64,
    length: f64,
}

impl OneChannel {
    /// The model of a whisker of `length` (m) whose deflection may be off by `deflection_spread` (rad).
    pub(super) fn new(curve: Arc<TipCurve>, deflection_spread: f64, length: f64) -> Self {
        Self { curve, deflection_spread, length }
    }
}

impl TipModel for OneChannel {
    fn touch(&mut self, deflection: f64, base: Pose) -> Option<Touch> {
        let covariance = self.curve.covariance(deflection, self.deflection_spread)?;
        Some(Touch::by_tip(self.curve.contact_base(deflection), &covariance, self.length, base))
    }
}
