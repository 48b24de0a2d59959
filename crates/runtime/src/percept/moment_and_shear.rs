//! The tip model of two channels: the moment and the shear at the base.

use nalgebra::{Matrix2, Vector2 as Column};

use crate::geometry::{Pose, Vector2, perpendicular, rotate, unit};
use crate::mechanics::{Bend, Elastica};
use crate::rig::{Sensing, Shaft, Whisker};
use crate::signal::Reading;

use super::base_angle::BaseAngle;
use super::recent_line::RecentLine;
use super::tip_model::{CONTACT_SPREAD, TipModel, Touch, turned};

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
    spreads: Column<f64>,
    contact_threshold: f64,
    /// Whether the newest sample has both readings.
    has_readings: bool,
    /// The newest bend that was found, or the straight shaft; where the next is sought from.
    near: Bend,
}

/// The spread of the shear that is worth a longer line through the readings, and what the mechanics leave out of it, over `EI / L²`.
const WANTED_SHEAR: f64 = 5e-4;
/// How far off the shape of the shaft may be where it is touched (m), as a standard deviation: shafts are not quite as even as the exact
/// theory has them, and a simulated one is a chain of links. Pressed along, as on a surface that a body is turned away from, they show it most.
const SHAPE_SPREAD: f64 = 3.5e-5;

impl MomentAndShear {
    pub(super) fn new(whisker: &Whisker, sensing: &Sensing) -> Self {
        let elastica = Elastica::new(whisker);
        let shaft = whisker.shaft.clone();
        let wanted_shear = WANTED_SHEAR * shaft.bending_stiffness() / shaft.length.powi(2);
        let angle = BaseAngle::new(whisker, sensing);
        let shear = RecentLine::new(sensing.sample_rate.recip(), 0.0, sensing.force_noise, wanted_shear);
        let spreads = Column::new(angle.spread, wanted_shear.hypot(sensing.force_noise * shear.noise_gain(0.0)));
        Self {
            near: elastica.straight(),
            elastica,
            shaft,
            angle,
            shear,
            spreads,
            contact_threshold: sensing.contact_threshold,
            has_readings: false,
        }
    }

    /// The bend by the newest readings.
    fn find(&self) -> Option<Bend> {
        let (angle, is_calm) = self.angle.value();
        let is_felt = self.has_readings && angle.abs() > self.contact_threshold && is_calm;
        if is_felt { self.elastica.locate(angle, self.shear.at(0.0).0, &self.near).ok() } else { None }
    }

    /// Where the surface is (m, frame of the base): the wire's radius beside its axis.
    fn surface(&self, bend: &Bend) -> Vector2 {
        let radius = self.shaft.radius_at(bend.contact_length / self.shaft.length);
        bend.contact_base - radius * unit(bend.force_direction)
    }

    /// Covariance of the place touched (m², frame of the base), by what the readings may be off. `None` where it hangs on nothing.
    fn covariance(&self, bend: &Bend) -> Option<Matrix2<f64>> {
        let changes = self.elastica.changes(bend)?;
        let radius = self.shaft.radius_at(bend.contact_length / self.shaft.length);
        let turned = -radius * perpendicular(unit(bend.force_direction));
        let by_readings = changes.fixed_rows::<2>(0) + turned * changes.row(2);
        let spread = by_readings * Matrix2::from_diagonal(&self.spreads);
        let covariance =
            spread * spread.transpose() + Matrix2::identity() * (CONTACT_SPREAD.powi(2) + SHAPE_SPREAD.powi(2));
        covariance.trace().is_finite().then_some(covariance)
    }
}

impl TipModel for MomentAndShear {
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

    fn touch(&mut self, _: f64, base: Pose) -> Option<Touch> {
        let Some(bend) = self.find() else {
            self.near = self.elastica.straight();
            return None;
        };
        self.near = bend;
        let covariance = self.covariance(&bend)?;
        let normal = unit(bend.force_direction);
        let spread = (normal.transpose() * covariance * normal).x.sqrt();
        Some(Touch {
            point_world: base.position + rotate(self.surface(&bend), base.heading),
            covariance_world: turned(&covariance, base.heading),
            spread,
            recorded_spread: spread,
            is_sure: true,
            contact_length: bend.contact_length,
        })
    }

    fn touch_at(&self, deflection: f64, _: f64) -> Option<Vector2> {
        if self.near.base_angle == 0.0 {
            return None;
        }
        // On the other side of the shaft it would be the mirror image.
        let near = if deflection * self.near.base_angle < 0.0 { self.near.mirrored() } else { self.near };
        let bend = self.elastica.solve_at(near.contact_length, deflection, near.force_direction, &near)?;
        Some(self.surface(&bend))
    }
}
