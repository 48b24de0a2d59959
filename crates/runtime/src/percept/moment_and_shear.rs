//! The contact estimator `moment_and_shear`.

use nalgebra::{Matrix2, Vector2 as Column};

use crate::geometry::{Pose, Vector2, perpendicular, rotate, unit};
use crate::math;
use crate::mechanics::{Elastica, ShaftShape};
use crate::rig::{Sensing, Shaft, Whisker};
use crate::signal::Reading;

use super::base_angle::BaseAngle;
use super::contact::{CONTACT_DEVIATION, Contact, rotated};
use super::contact_estimator::ContactEstimator;
use super::recent_line::RecentLine;

/// Finds the frictionless contact that causes the moment and the shear at the base. It also locates contacts of the
/// shaft.
///
/// Base angle and shear are values of straight lines through the newest readings, over no more of them than their noise
/// requires. The shear of a freely moving whisker is not that of a contact. So there is no estimate while the base
/// angle changes fast.
#[derive(Debug, Clone)]
pub(super) struct MomentAndShear {
    elastica: Elastica,
    shaft: Shaft,
    /// Equilibrium base angle.
    angle: BaseAngle,
    /// Line through the newest readings of the shear (N).
    shear: RecentLine,
    /// Standard deviations of the base angle (rad) and of the shear (N).
    deviations: Column<f64>,
    /// True if the newest sample has both readings.
    has_readings: bool,
    /// Shape at the newest contact, or the straight shaft. It is the initial guess for the next one.
    near: ShaftShape,
}

/// Standard deviation of the shear, over `EI / L²`, up to which its line is lengthened. It is also the error of the
/// model.
const WANTED_SHEAR: f64 = 5e-4;
/// Standard deviation (m) of the shape of the shaft at the contact. Real shafts are less uniform than the exact theory,
/// and a simulated one is a chain of links. The error is largest with a large axial force, as on a surface from which
/// the body turns away.
const SHAPE_DEVIATION: f64 = 3.5e-5;

impl MomentAndShear {
    /// Creates the estimator of `whisker`.
    pub(super) fn new(whisker: &Whisker, sensing: &Sensing) -> Self {
        let elastica = Elastica::new(whisker);
        let shaft = whisker.shaft.clone();
        let wanted_shear = WANTED_SHEAR * shaft.bending_stiffness() / math::square(shaft.length);
        let angle = BaseAngle::new(whisker, sensing);
        let mut shear = RecentLine::new(sensing.sample_rate.recip());
        shear.fit_to(0.0, sensing.force_noise, wanted_shear);
        let deviations =
            Column::new(angle.deviation, math::hypot(wanted_shear, sensing.force_noise * shear.noise_gain(0.0)));
        Self { near: elastica.straight(), elastica, shaft, angle, shear, deviations, has_readings: false }
    }

    /// The shape according to the newest readings.
    fn find(&self) -> Option<ShaftShape> {
        let (angle, is_calm) = self.angle.value();
        let has_contact = self.has_readings && angle.abs() > self.angle.contact_threshold && is_calm;
        if has_contact { self.elastica.locate(angle, self.shear.at(0.0).0, &self.near).ok() } else { None }
    }

    /// Contact position on the surface (m, frame of the base): the radius of the shaft beside its axis.
    fn surface(&self, shape: &ShaftShape) -> Vector2 {
        let radius = self.shaft.radius_at(shape.contact_length / self.shaft.length);
        shape.contact_base - radius * unit(shape.force_direction)
    }

    /// Covariance of the contact position (m², frame of the base) due to errors of readings and model. `None` if the
    /// position does not depend on the readings.
    fn covariance(&self, shape: &ShaftShape) -> Option<Matrix2<f64>> {
        let changes = self.elastica.changes(shape)?;
        let radius = self.shaft.radius_at(shape.contact_length / self.shaft.length);
        let rotated = -radius * perpendicular(unit(shape.force_direction));
        let by_readings = changes.fixed_rows::<2>(0) + rotated * changes.row(2);
        let deviation = by_readings * Matrix2::from_diagonal(&self.deviations);
        let covariance = deviation * deviation.transpose()
            + Matrix2::identity() * (math::square(CONTACT_DEVIATION) + math::square(SHAPE_DEVIATION));
        covariance.trace().is_finite().then_some(covariance)
    }
}

impl ContactEstimator for MomentAndShear {
    fn take(&mut self, reading: &Reading, _: Pose) {
        self.angle.take(reading.base_angle);
        let shear = reading.shear.filter(|shear| shear.is_finite());
        self.has_readings = shear.is_some();
        match shear {
            Some(shear) => self.shear.take(shear),
            None => self.shear.clear(),
        }
    }

    fn interrupt(&mut self) {
        self.angle.clear();
        self.shear.clear();
        self.has_readings = false;
    }

    fn set_noise(&mut self, noise: f64) {
        self.angle.set_noise(noise);
        self.deviations.x = self.angle.deviation;
    }

    fn contact(&mut self, _: f64, base: Pose) -> Option<Contact> {
        let Some(shape) = self.find() else {
            self.near = self.elastica.straight();
            return None;
        };
        self.near = shape;
        let covariance = self.covariance(&shape)?;
        let normal = unit(shape.force_direction);
        let deviation = (normal.transpose() * covariance * normal).x.sqrt();
        Some(Contact {
            point_world: base.position + rotate(self.surface(&shape), base.heading),
            covariance_world: rotated(&covariance, base.heading),
            deviation,
            recorded_deviation: deviation,
            bias: 0.0,
            is_recordable: true,
            contact_length: shape.contact_length,
        })
    }

    fn contact_at(&self, base_angle: f64, _: f64) -> Option<Vector2> {
        if self.near.base_angle == 0.0 {
            return None;
        }
        // A bend to the other side is the mirror image.
        let near = if base_angle * self.near.base_angle < 0.0 { self.near.mirrored() } else { self.near };
        let shape = self.elastica.solve_at(near.contact_length, base_angle, near.force_direction, &near)?;
        Some(self.surface(&shape))
    }
}
