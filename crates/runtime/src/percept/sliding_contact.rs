//! The contact of a sliding tip.

use nalgebra::Matrix2;

use crate::geometry::{Point2, Vector2, perpendicular, unit};
use crate::math;

use super::contact::CONTACT_DEVIATION;
use super::tip_table::TipPosition;

/// The contact of a sliding tip.
#[derive(Debug, Clone, Copy)]
pub(super) struct SlidingContact {
    /// +1 for a counter-clockwise bend, −1 for a clockwise one.
    pub(super) bend_sign: f64,
    /// The tip's centre (m, world frame), and its positions at the three previous samples.
    pub(super) centre: Point2,
    pub(super) before: [Point2; 3],
    /// Direction of the surface normal (rad, world frame), towards the whisker.
    pub(super) normal: f64,
    /// Covariance of the normal's direction (rad) and of the centre's position along the normal (m).
    pub(super) covariance: Matrix2<f64>,
    /// The same covariance with the errors that the gain ignores: contacts with different compliance.
    pub(super) considered: Matrix2<f64>,
    /// Change of the normal's direction (rad/s) and of the centre (m/s, world frame) by the delay of poses behind
    /// readings.
    pub(super) by_delay: (f64, Vector2),
    /// The tip position by the mechanics, with its derivatives by the base angle and by the normal's direction.
    pub(super) tip: TipPosition,
    /// Position of the first contact (m, world frame), and the largest distance from it since (m). The variance of the
    /// position (m²) covers the case that the shaft and not the tip touched first.
    pub(super) first: Point2,
    pub(super) farthest: f64,
    pub(super) first_variance: f64,
}

/// Standard deviation of the centre's position at a light contact (m).
const FIRST_POSITION: f64 = 2e-5;
/// Standard deviation (m) of the position at a first contact with an unknown surface, because an edge may have touched
/// the shaft first. The path (m) on which this variance decreases by a factor e while the tip approaches the edge.
pub(super) const SHAFT_FIRST: (f64, f64) = (2.7e-4, 1.5e-3);

impl SlidingContact {
    /// Creates the contact of a tip that has just touched. `normal` (rad, world frame) is the direction of the surface
    /// normal, and `variance` (rad²) its variance.
    pub(super) fn new(bend_sign: f64, tip: &TipPosition, normal: f64, variance: f64) -> Self {
        let centre = Point2::from(tip.tip_base);
        // The position depends on the direction, so their errors are correlated.
        let slope = tip.by_direction.dot(&unit(normal));
        let covariance = variance * Matrix2::new(1.0, slope, slope, slope * slope)
            + Matrix2::new(0.0, 0.0, 0.0, math::square(FIRST_POSITION));
        let before = [centre; 3];
        Self {
            bend_sign,
            centre,
            before,
            normal,
            covariance,
            considered: covariance,
            by_delay: (0.0, Vector2::zeros()),
            tip: *tip,
            first: centre,
            farthest: 0.0,
            first_variance: 0.0,
        }
    }

    /// Standard deviation of the position along the normal (m), for a covariance like that of the contact.
    pub(super) fn position_deviation(&self, covariance: &Matrix2<f64>) -> f64 {
        let first = self.first_variance * math::exp(-self.farthest / SHAFT_FIRST.1);
        math::hypot((math::max(covariance.m22, 0.0) + first).sqrt(), CONTACT_DEVIATION)
    }

    /// Covariance of the contact position (m², world frame) for a tip of this radius (m). `angle_deviation` (rad) is
    /// the standard deviation of the base angle. Along the surface the position follows from base angle and direction.
    pub(super) fn position_covariance(&self, tip_radius: f64, angle_deviation: f64) -> Matrix2<f64> {
        let normal = unit(self.normal);
        let tangent = perpendicular(normal);
        let by_direction = self.tip.by_direction.dot(&tangent) - tip_radius;
        let along = math::square(by_direction) * self.covariance.m11
            + math::square(self.tip.by_angle.dot(&tangent) * angle_deviation);
        let both = by_direction * self.covariance.m12;
        along * tangent * tangent.transpose()
            + both * (tangent * normal.transpose() + normal * tangent.transpose())
            + math::square(self.position_deviation(&self.covariance)) * normal * normal.transpose()
    }
}
