//! The contact estimator `recursive`: the base angle as a polynomial in the tip position.

use std::sync::Arc;

use nalgebra::Matrix2;

use crate::calibration::{AngleSurface, ContactSet};
use crate::geometry::{Pose, Vector2, unit};
use crate::math;
use crate::rig::{Sensing, Whisker};
use crate::signal::Reading;

use super::base_angle::BaseAngle;
use super::contact::Contact;
use super::contact_estimator::ContactEstimator;
use super::tip_curve::TipCurve;
use super::tip_table::TipTable;

/// Tracks the tip position in the frame of the base with a Kalman filter. The prediction moves the tip as the tip curve
/// does. The correction is a step along the gradient of `z = f(x, y)` to a position with the measured base angle.
///
/// The base angle does not determine the position along the line `f = z`. This part keeps its value from the first
/// contact, and its uncertainty grows with the path.
#[derive(Debug, Clone)]
pub(super) struct Recursive {
    /// The base angle by contact position.
    surface: Arc<AngleSurface>,
    /// The tip curve, for first contacts and predictions.
    curve: Arc<TipCurve>,
    /// Equilibrium base angle.
    angle: BaseAngle,
    /// Standard deviation of the base angle (rad), including the residual of the polynomial.
    angle_deviation: f64,
    /// Length of the shaft (m).
    length: f64,
    /// The tip, during a contact.
    tip: Option<Tip>,
    /// Pose of the base at the previous sample.
    base_before: Option<Pose>,
}

/// A tip in contact, mirrored to a bend to the left.
#[derive(Debug, Clone, Copy)]
struct Tip {
    /// +1 for a counter-clockwise bend, −1 for a clockwise one.
    bend_sign: f64,
    /// Magnitude of the base angle (rad).
    base_angle: f64,
    /// Position (m, frame of the base).
    position: Vector2,
    /// Covariance of the position (m²).
    covariance: Matrix2<f64>,
}

/// Growth of the variance of the position per path of the base (m²/m): 1 mm after 10 mm.
const SLIDING: f64 = 1e-4;

/// Range and step of the force direction (degrees) for a polynomial fitted to the mechanics. The number of base angles,
/// from the lower half of the table.
const DIRECTIONS: (usize, usize, usize) = (100, 200, 4);
const ANGLES: usize = 40;

/// Fits the polynomial of an uncalibrated whisker to its mechanics. `None` if they give too few positions.
pub(super) fn surface(whisker: &Whisker, table: &TipTable) -> Option<AngleSurface> {
    let (first, last, step) = DIRECTIONS;
    let positions = (first..=last).step_by(step).flat_map(|degrees| (0..=ANGLES).map(move |angle| (degrees, angle)));
    let sets = positions.filter_map(|(degrees, angle)| {
        let (normal, base_angle) = ((degrees as f64).to_radians(), table.range() * angle as f64 / (2 * ANGLES) as f64);
        let tip = table.at(base_angle, normal)?.tip_base;
        let contact_base = tip - whisker.shaft.radius_at(1.0) * unit(normal);
        Some(ContactSet { contact_base, base_angle, normal: Some(normal), on_shaft: false })
    });
    AngleSurface::fit(&sets.collect::<Vec<_>>())
}

impl Recursive {
    /// Creates the estimator of `whisker`.
    pub(super) fn new(whisker: &Whisker, surface: Arc<AngleSurface>, curve: Arc<TipCurve>, sensing: &Sensing) -> Self {
        let angle = BaseAngle::new(whisker, sensing);
        Self {
            angle_deviation: math::hypot(angle.deviation, surface.deviation),
            surface,
            curve,
            angle,
            length: whisker.shaft.length,
            tip: None,
            base_before: None,
        }
    }

    /// The first position of a tip, from the tip curve.
    fn first(&self, bend_sign: f64, base_angle: f64) -> Option<Tip> {
        let covariance = self.curve.covariance(base_angle, self.angle_deviation)?;
        Some(Tip { bend_sign, base_angle, position: self.curve.contact_base(base_angle), covariance })
    }

    /// One step of the filter after the base has moved along `path` (m).
    fn advance(&self, last: &Tip, base_angle: f64, path: f64) -> Option<Tip> {
        let usual = self.curve.contact_base(base_angle) - self.curve.contact_base(last.base_angle);
        let carried = last.position + usual;
        let covariance = last.covariance + Matrix2::identity() * (SLIDING * path);
        let (expected, gradient) = self.surface.at(carried);
        let variance = (gradient.transpose() * covariance * gradient).x + math::square(self.angle_deviation);
        let gain = covariance * gradient / variance;
        let position = carried + gain * (base_angle - expected);
        let covariance = covariance - variance * gain * gain.transpose();
        self.surface.contains(position).then_some(Tip { bend_sign: last.bend_sign, base_angle, position, covariance })
    }
}

impl ContactEstimator for Recursive {
    fn take(&mut self, reading: &Reading, base: Pose) {
        self.angle.take(reading.base_angle);
        let (angle, _) = self.angle.value();
        let (bend_sign, base_angle) = (angle.signum(), angle.abs());
        let path = self.base_before.map_or(0.0, |before| {
            (base.position - before.position).norm() + self.length * (base.heading - before.heading).abs()
        });
        self.base_before = Some(base);
        self.tip = match self.tip {
            _ if base_angle < self.angle.contact_threshold => None,
            Some(last) if last.bend_sign * bend_sign > 0.0 => self.advance(&last, base_angle, path),
            _ => self.first(bend_sign, base_angle),
        };
    }

    fn interrupt(&mut self) {
        self.angle.clear();
        self.tip = None;
        self.base_before = None;
    }

    fn set_noise(&mut self, noise: f64) {
        self.angle.set_noise(noise);
        self.angle_deviation = math::hypot(self.angle.deviation, self.surface.deviation);
    }

    fn contact(&mut self, _: f64, base: Pose) -> Option<Contact> {
        let Tip { bend_sign, position, mut covariance, .. } =
            self.tip.filter(|tip| self.surface.contains(tip.position))?;
        covariance.m12 *= bend_sign;
        covariance.m21 = covariance.m12;
        let position = Vector2::new(position.x, bend_sign * position.y);
        Some(Contact::by_tip(position, &covariance, self.length, base))
    }
}
