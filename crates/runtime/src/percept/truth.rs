//! The contact estimator `truth`: an ideal sensor of the tip position.

use std::sync::Arc;

use nalgebra::Matrix2;

use crate::geometry::{Pose, Vector2, rotate};
use crate::math;
use crate::signal::{Reading, TrueTip};

use super::contact::{CONTACT_DEVIATION, Contact};
use super::contact_estimator::ContactEstimator;
use super::tip_curve::TipCurve;

/// Passes on the true tip of the newest sample. It separates errors of a policy from errors of perception.
///
/// True tips reach it in the samples like all other readings. Only a simulator supplies them.
#[derive(Debug, Clone)]
pub(super) struct Truth {
    /// The change of the tip position with the base angle.
    curve: Arc<TipCurve>,
    /// Length of the shaft (m).
    length: f64,
    /// The true tip of the newest sample.
    newest: Option<TrueTip>,
    /// The tip (m, frame of the base) and the base angle (rad) of this tick.
    tip: Option<(Vector2, f64)>,
}

impl Truth {
    /// Creates the estimator of a whisker of `length` (m). `curve` gives the tip at other base angles.
    pub(super) fn new(curve: Arc<TipCurve>, length: f64) -> Self {
        Self { curve, length, newest: None, tip: None }
    }
}

impl ContactEstimator for Truth {
    fn take(&mut self, reading: &Reading, _: Pose) {
        self.newest = reading.true_tip;
    }

    fn interrupt(&mut self) {
        self.newest = None;
    }

    fn contact(&mut self, base_angle: f64, base: Pose) -> Option<Contact> {
        let tip_base = |tip: TrueTip| (rotate(tip.point_world - base.position, -base.heading), base_angle);
        self.tip = self.newest.map(tip_base);
        // The base angle is filtered, so it follows a tip that has left the surface some ticks later. Without a contact, the
        // tip follows from the base angle, and both are of the same time.
        let point_world = self.newest.filter(|tip| tip.touches)?.point_world;
        Some(Contact {
            point_world,
            // A true tip penetrates a compliant surface.
            covariance_world: Matrix2::identity() * math::square(CONTACT_DEVIATION),
            deviation: CONTACT_DEVIATION,
            recorded_deviation: CONTACT_DEVIATION,
            bias: 0.0,
            is_recordable: true,
            contact_length: self.length,
        })
    }

    fn contact_at(&self, base_angle: f64, _: f64) -> Option<Vector2> {
        let (tip_base, now) = self.tip?;
        Some(tip_base + self.curve.contact_base(base_angle) - self.curve.contact_base(now))
    }
}
