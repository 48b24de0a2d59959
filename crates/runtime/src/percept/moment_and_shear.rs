//! The tip model of two channels: the moment and the shear at the base.

use nalgebra::{Matrix2, Vector2 as Column};

use crate::geometry::{Pose, Vector2, perpendicular, rotate, unit};
use crate::mechanics::{Elastica, ShaftShape};
use crate::rig::{Sensing, Shaft, Whisker};
use crate::signal::Reading;

use super::base_angle::BaseAngle;
use super::contact::{CONTACT_DEVIATION, Contact, turned};
use super::contact_estimator::ContactEstimator;
use super::recent_line::RecentLine;

/// Finds the touch without friction that has the moment and the shear of the base; on the shaft, too.
///
/// Base angle and shear are those of straight lines through the newest readings, no longer than their noise asks for. A whisker in free
/// motion has a shear that no touch makes: while the base angle changes fast nothing is told.
#[derive(Debug, Clone)]
pub(super) struct MomentAndShear {
    elastica: Elastica,
    shaft: Shaft,
    angle: BaseAngle,
    shear: RecentLine,
    /// Standard deviation of the base angle (rad) and of the shear (N).
    deviations: Column<f64>,
    contact_threshold: f64,
    /// Whether the newest sample has both readings.
    has_readings: bool,
    /// The newest bend that was found, or the straight shaft; where the next is sought from.
    near: ShaftShape,
}

/// The spread of the shear that is worth a longer line through the readings, and what the mechanics leave out of it, over `EI / L²`.
const WANTED_SHEAR: f64 = 5e-4;
/// How far off the shape of the shaft may be where it is touched (m), as a standard deviation: shafts are not quite as even as the exact
/// theory has them, and a simulated one is a chain of links. Pressed along, as on a surface that a body is turned away from, they show it most.
const SHAPE_DEVIATION: f64 = 3.5e-5;

impl MomentAndShear {
    pub(super) fn new(whisker: &Whisker, sensing: &Sensing) -> Self {
        let elastica = Elastica::new(whisker);
        let shaft = whisker.shaft.clone();
        let wanted_shear = WANTED_SHEAR * shaft.bending_stiffness() / shaft.length.powi(2);
        let angle = BaseAngle::new(whisker, sensing);
        let shear = RecentLine::new(sensing.sample_rate.recip(), 0.0, sensing.force_noise, wanted_shear);
        let deviations = Column::new(angle.deviation, wanted_shear.hypot(sensing.force_noise * shear.noise_gain(0.0)));
        Self {
            near: elastica.straight(),
            elastica,
            shaft,
            angle,
            shear,
            deviations,
            contact_threshold: sensing.contact_threshold,
            has_readings: false,
        }
    }

    /// The bend by the newest readings.
    fn find(&self) -> Option<ShaftShape> {
        let (angle, is_calm) = self.angle.value();
        let has_contact = self.has_readings && angle.abs() > self.contact_threshold && is_calm;
        if has_contact { self.elastica.locate(angle, self.shear.at(0.0).0, &self.near).ok() } else { None }
    }

    /// Where the surface is (m, frame of the base): the wire's radius beside its axis.
    fn surface(&self, shape: &ShaftShape) -> Vector2 {
        let radius = self.shaft.radius_at(shape.contact_length / self.shaft.length);
        shape.contact_base - radius * unit(shape.force_direction)
    }

    /// Covariance of the place touched (m², frame of the base), by what the readings may be off. `None` where it hangs on nothing.
    fn covariance(&self, shape: &ShaftShape) -> Option<Matrix2<f64>> {
        let changes = self.elastica.changes(shape)?;
        let radius = self.shaft.radius_at(shape.contact_length / self.shaft.length);
        let turned = -radius * perpendicular(unit(shape.force_direction));
        let by_readings = changes.fixed_rows::<2>(0) + turned * changes.row(2);
        let deviation = by_readings * Matrix2::from_diagonal(&self.deviations);
        let covariance = deviation * deviation.transpose()
            + Matrix2::identity() * (CONTACT_DEVIATION.powi(2) + SHAPE_DEVIATION.powi(2));
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
            covariance_world: turned(&covariance, base.heading),
            deviation,
            recorded_deviation: deviation,
            is_recordable: true,
            contact_length: shape.contact_length,
        })
    }

    fn contact_at(&self, base_angle: f64, _: f64) -> Option<Vector2> {
        if self.near.base_angle == 0.0 {
            return None;
        }
        // On the other side of the shaft it would be the mirror image.
        let near = if base_angle * self.near.base_angle < 0.0 { self.near.mirrored() } else { self.near };
        let shape = self.elastica.solve_at(near.contact_length, base_angle, near.force_direction, &near)?;
        Some(self.surface(&shape))
    }
}
