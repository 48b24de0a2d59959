//! Where the shaft of a whisker touches.

use crate::geometry::{Matrix2, Point2, Pose, Vector2, perpendicular, unit};
use crate::math;
use crate::mechanics::Pivot;
use crate::rig::Whisker;

/// Readings of one contact that are used. At 30 Hz they are a quarter of a second.
const READINGS: usize = 8;
/// Fewest readings for a place. Two coordinates take two, and the others show whether the place is fixed.
const FEWEST: usize = 5;
/// Error of the mechanics as a share of the base angle.
const MODEL_SHARE: f64 = 3e-3;
/// Shares of the shaft at which a place is searched first.
const LEAST_SHARE: f64 = 0.1;
const SHARES: usize = 12;
/// Steps of the Gauss-Newton method, and the longest step (m).
const STEPS: usize = 4;
const LONGEST_STEP: f64 = 10e-3;
/// Difference (m) for derivatives. Base angles are smooth over it.
const DIFFERENCE: f64 = 1e-5;
/// Largest misfit of the readings in standard deviations (root of the mean square) of a place that is fixed.
const MOST_MISFIT: f64 = 1.5;
/// Standard deviations, and the length (m) beyond them, by which a contact is nearer to the base than the tip. Friction may shift it
/// by less than a millimetre, and a tip is rounded.
const SURE: (f64, f64) = (3.0, 2e-3);
/// Largest standard deviation (m) of the distance. With more the linear covariance says little, and plans need no better place.
const MOST_DEVIATION: f64 = 5e-3;

/// A contact of a whisker at a fixed place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ShaftContact {
    /// Position of the shaft's axis at the contact (m, world frame).
    pub place: Point2,
    /// Covariance of the position (m², world frame).
    pub covariance: Matrix2,
    /// Unit normal (world frame) of the shaft at the contact, away from the object.
    pub normal: Vector2,
    /// Distance of the place from the base (m).
    pub distance: f64,
    /// Standard deviation (m) of that distance. It is what is known worst.
    pub deviation: f64,
    /// Misfit of the readings in standard deviations. A place that moves, such as that of a sliding tip, has more than 1.5.
    pub misfit: f64,
    /// True if the place is fixed and surely nearer to the base than the tip. Otherwise the contact may be that of the tip.
    pub is_shaft: bool,
}

/// A base angle with the pose of the base.
#[derive(Debug, Clone, Copy, Default)]
struct Reading {
    base: Point2,
    axis: Vector2,
    angle: f64,
    /// Standard deviation (rad).
    deviation: f64,
}

impl Reading {
    fn to_base(self, place: Point2) -> Vector2 {
        let offset = place - self.base;
        Vector2::new(self.axis.dot(&offset), perpendicular(self.axis).dot(&offset))
    }

    fn to_world(self, place: Vector2) -> Point2 {
        self.base + place.x * self.axis + place.y * perpendicular(self.axis)
    }
}

/// Fits a place that is fixed in the world to the newest readings of a whisker in contact.
///
/// A fixed place explains the base angles of all poses by the closed form of [`Pivot`]. Only a rotation of the base tells the
/// distance of the place, so the standard deviation comes from the poses themselves.
#[derive(Debug, Clone)]
pub(super) struct ShaftFit {
    pivot: Pivot,
    length: f64,
    readings: [Reading; READINGS],
    count: usize,
    /// The last place, from which the next fit starts.
    place: Option<Point2>,
}

impl ShaftFit {
    /// Creates the fit for the shaft of `whisker`, as perception models it.
    pub(super) fn new(whisker: &Whisker) -> Self {
        Self {
            pivot: Pivot::new(whisker),
            length: whisker.shaft.length,
            readings: [Reading::default(); READINGS],
            count: 0,
            place: None,
        }
    }

    /// Forgets the contact.
    pub(super) fn end(&mut self) {
        (self.count, self.place) = (0, None);
    }

    /// Adds a base angle (rad) with its standard deviation (rad), and the pose of the base at its time.
    pub(super) fn take(&mut self, angle: f64, deviation: f64, base: Pose) {
        // A bend to the other side is another contact.
        if self.count > 0 && angle * self.readings[READINGS - 1].angle <= 0.0 {
            self.end();
        }
        let deviation = math::hypot(deviation, MODEL_SHARE * angle);
        self.readings.rotate_left(1);
        self.readings[READINGS - 1] = Reading { base: base.position, axis: unit(base.heading), angle, deviation };
        self.count = (self.count + 1).min(READINGS);
    }

    /// The readings of the contact.
    fn used(&self) -> &[Reading] {
        &self.readings[READINGS - self.count..]
    }

    /// The fixed place that explains the readings best. `None` if there are too few, or if no place explains them.
    pub(super) fn contact(&mut self) -> Option<ShaftContact> {
        if self.count < FEWEST {
            return None;
        }
        let newest = self.readings[READINGS - 1];
        let mut place = match self.place {
            Some(place) => place,
            None => self.searched()?,
        };
        for _ in 0..STEPS {
            let (gradient, information) = self.normal_equations(place)?;
            let step = information.try_inverse()? * gradient;
            let shorter = math::min(1.0, LONGEST_STEP / math::max(step.norm(), f64::MIN_POSITIVE));
            place -= shorter * step;
        }
        let (_, information) = self.normal_equations(place)?;
        let covariance = information.try_inverse()?;
        let distance = (place - newest.base).norm();
        if !distance.is_finite() || distance > 2.0 * self.length {
            self.place = None;
            return None;
        }
        self.place = Some(place);
        let misfit = (self.cost(place)? / (self.count - 2) as f64).sqrt();
        let along = (place - newest.base) / distance;
        // A misfit enlarges the covariance, because a wrong model is no better than its residuals.
        let covariance = covariance * math::max(1.0, math::square(misfit));
        let deviation = math::max((along.transpose() * covariance * along).x, 0.0).sqrt();
        let left = perpendicular(along);
        Some(ShaftContact {
            place,
            covariance,
            normal: newest.angle.signum() * left,
            distance,
            deviation,
            misfit,
            is_shaft: misfit < MOST_MISFIT
                && deviation < MOST_DEVIATION
                && distance + SURE.0 * deviation + SURE.1 < self.length,
        })
    }

    /// The best place on the newest shaft, among some.
    fn searched(&self) -> Option<Point2> {
        let newest = self.readings[READINGS - 1];
        let mut best: Option<(f64, Point2)> = None;
        for index in 0..SHARES {
            let share = LEAST_SHARE + (1.0 - LEAST_SHARE) * index as f64 / (SHARES - 1) as f64;
            let Some(local) = self.pivot.contact_base(newest.angle, share * self.length) else { continue };
            let place = newest.to_world(local);
            if let Some(cost) = self.cost(place)
                && best.is_none_or(|(least, _)| cost < least)
            {
                best = Some((cost, place));
            }
        }
        best.map(|(_, place)| place)
    }

    /// Misfit of a reading with a place, in standard deviations.
    fn residual(&self, reading: &Reading, place: Point2) -> Option<f64> {
        Some((self.pivot.base_angle(reading.to_base(place))? - reading.angle) / reading.deviation)
    }

    /// Sum of the squared misfits.
    fn cost(&self, place: Point2) -> Option<f64> {
        self.used().iter().map(|reading| self.residual(reading, place).map(math::square)).sum()
    }

    /// The gradient of half the cost, and its approximate second derivative.
    fn normal_equations(&self, place: Point2) -> Option<(Vector2, Matrix2)> {
        let (mut gradient, mut information) = (Vector2::zeros(), Matrix2::zeros());
        for reading in self.used() {
            let at = |x: f64, y: f64| self.residual(reading, place + Vector2::new(x, y));
            let slope = Vector2::new(
                at(DIFFERENCE, 0.0)? - at(-DIFFERENCE, 0.0)?,
                at(0.0, DIFFERENCE)? - at(0.0, -DIFFERENCE)?,
            ) / (2.0 * DIFFERENCE);
            gradient += slope * at(0.0, 0.0)?;
            information += slope * slope.transpose();
        }
        Some((gradient, information))
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]

    use std::f64::consts::FRAC_PI_2;

    use proptest::prelude::*;

    use super::*;
    use crate::mechanics::Elastica;
    use crate::rig::Rig;

    const NOISE: f64 = 2e-7;

    /// Readings of the exact elastica on a corner at `place`, from a light contact on. `turned` (rad) is the rotation of the
    /// base. The contact slides along the shaft by `slide` of its length in each reading.
    fn fit(place: Point2, share: f64, (from, to): (f64, f64), slide: f64, noise: &[f64]) -> (ShaftFit, f64) {
        let whisker = Rig::default().whiskers.remove(0);
        let mut fit = ShaftFit::new(&whisker);
        let (elastica, length) = (Elastica::new(&whisker), whisker.shaft.length);
        let unit_force = whisker.shaft.bending_stiffness() / math::square(length);
        let mut distance = 0.0;
        for (index, noise) in noise.iter().enumerate() {
            let along = index as f64 / (READINGS - 1) as f64;
            let share = share + slide * index as f64;
            // Nearer to the base the same rotation takes more force.
            let force = (from + (to - from) * along) / math::square(share);
            let shape = elastica.under(share * length, FRAC_PI_2, force * unit_force).unwrap();
            // The base rotates against the bend, about itself.
            let heading = -math::atan2(shape.contact_base.y, shape.contact_base.x);
            let offset = crate::geometry::rotate(shape.contact_base, heading);
            distance = shape.contact_base.norm();
            fit.take(shape.base_angle + NOISE * noise, NOISE, Pose { position: place - offset, heading });
        }
        (fit, distance)
    }

    proptest! {
        #[test]
        fn the_distance_of_a_corner_is_found_within_its_standard_deviation(
            share in 0.25..0.9_f64, to in 0.3..0.8_f64, noise in prop::collection::vec(-1.7..1.7_f64, READINGS),
        ) {
            let place = Point2::new(0.3, -0.2);
            let (mut fit, distance) = fit(place, share, (0.05, to), 1e-4, &noise);
            let found = fit.contact().unwrap();
            let error = (found.place - place).norm();
            prop_assert!((found.distance - distance).abs() < 4.0 * found.deviation + 1e-4, "{} {distance} {}", found.distance, found.deviation);
            prop_assert!(error < 4.0 * found.covariance.trace().sqrt() + 1e-4);
            prop_assert!(found.deviation < 6e-3, "{} m", found.deviation);
            // On its bent side the object is against the normal.
            prop_assert!(found.misfit < 2.5, "{}", found.misfit);
            if share > 0.25 && share < 0.7 && to > 0.5 && found.misfit < MOST_MISFIT {
                prop_assert!(found.is_shaft, "{found:?}");
            }
        }

        #[test]
        fn a_base_that_does_not_rotate_does_not_know_the_distance(share in 0.3..0.9_f64, noise in prop::collection::vec(-1.7..1.7_f64, READINGS)) {
            let (mut fit, _) = fit(Point2::new(0.3, -0.2), share, (0.3, 0.301), 0.0, &noise);
            let found = fit.contact();
            prop_assert!(found.is_none_or(|found| !found.is_shaft), "{found:?}");
        }
    }

    #[test]
    fn a_tip_that_slides_along_a_wall_is_no_shaft() {
        let whisker = Rig::default().whiskers.remove(0);
        let elastica = Elastica::new(&whisker);
        let unit_force = whisker.shaft.bending_stiffness() / math::square(whisker.shaft.length);
        for speed in [1e-3, 3e-3] {
            let mut fit = ShaftFit::new(&whisker);
            for index in 0..READINGS {
                let force = 0.4 + 0.05 * index as f64;
                let shape = elastica.under(whisker.shaft.length, FRAC_PI_2 + 0.3, force * unit_force).unwrap();
                let along = perpendicular(unit(shape.force_direction)) * (speed * index as f64);
                let position = Point2::origin() + along - shape.tip_base;
                fit.take(shape.base_angle, NOISE, Pose { position, heading: 0.0 });
            }
            assert!(fit.contact().is_none_or(|found| !found.is_shaft), "{:?}", fit.contact());
        }
    }
}
