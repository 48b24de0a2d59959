//! The estimated contact of a whisker.

use super::pose_noise::PoseDeviation;
use crate::geometry::{Matrix2, Point2, Pose, Vector2, perpendicular, rotate};
use crate::math;

/// The contact of a whisker, as estimated by a contact estimator.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Contact {
    /// Contact position on the surface (m, world frame). It is not on the axis of the shaft.
    pub point_world: Point2,
    /// Covariance of the position (m², world frame).
    pub covariance_world: Matrix2,
    /// Standard deviation of the position (m), along the surface normal if the estimator knows it, else in both
    /// directions.
    pub deviation: f64,
    /// Standard deviation (m) for the record: `deviation` with those errors of the model that readings cannot reveal.
    pub recorded_deviation: f64,
    /// Standard deviation of the position (m) that the errors of the calibration cause. It is the same error at all
    /// contacts that are alike, so it is not part of the scatter. 0 without a calibration by touches.
    pub bias: f64,
    /// True if the position may be recorded. False while another part than the tip may be in contact.
    pub is_recordable: bool,
    /// Length of the shaft from the base to the contact (m). For a tip contact it is the whole length.
    pub contact_length: f64,
}

impl Contact {
    /// Creates a tip contact on a surface of unknown direction.
    ///
    /// `position` (m) and `covariance` (m²) are in the frame of the base, `length` (m) is that of the whisker, and
    /// `base` is the pose of the base.
    #[must_use]
    pub fn by_tip(position: Vector2, covariance: &Matrix2, length: f64, base: Pose) -> Self {
        let deviation = covariance.trace().sqrt();
        Self {
            point_world: base.position + rotate(position, base.heading),
            covariance_world: rotated(covariance, base.heading),
            deviation,
            recorded_deviation: deviation,
            bias: 0.0,
            is_recordable: true,
            contact_length: length,
        }
    }

    /// Adds errors of the platform's pose `body` to the covariance and to the deviation for the record. They do not
    /// decrease while a tip slides, so `deviation` is without them.
    pub(super) fn add_pose_errors(&mut self, body: Pose, errors: PoseDeviation) {
        let swing = errors.heading * perpendicular(self.point_world - body.position);
        let added = Matrix2::identity() * math::square(errors.position) + swing * swing.transpose();
        self.covariance_world += added;
        let along_any = (math::square(errors.position) + swing.norm_squared()).sqrt();
        self.recorded_deviation = math::hypot(self.recorded_deviation, along_any);
    }
}

/// Standard deviation (m) of the surface from its position by the mechanics. Contacts are slightly compliant, and a
/// sliding tip lags. In one scene the error may always have the same sign.
pub(super) const CONTACT_DEVIATION: f64 = 2.2e-5;

/// Rotates a covariance by an angle (rad).
pub(super) fn rotated(covariance: &Matrix2, angle: f64) -> Matrix2 {
    let (sin, cos) = math::sin_cos(angle);
    let turn = Matrix2::new(cos, -sin, sin, cos);
    turn * covariance * turn.transpose()
}
