//! Whether the shaft may rest on a corner where the tip is taken to touch.

use crate::geometry::{Point2, Pose, Vector2, perpendicular, unit, wrap};
use crate::mechanics::Pivot;
use crate::rig::Whisker;

/// Tells how far off a tip may be because the shaft touches instead.
///
/// One base angle fits a touch of the tip and touches of the shaft alike. But a corner stays where it is while the base moves. If one
/// fixed place in the world explains the newest readings, the shaft may rest there. The tip is then in doubt by the distance
/// between the two. Behind a rest the doubt fades on the way on which the errors of [`Sliding`](super::sliding::Sliding) fade. A place that
/// turns out to move was no corner, and leaves no doubt.
#[derive(Debug, Clone)]
pub(super) struct ShaftRest {
    pivot: Pivot,
    /// Length of the shaft (m).
    length: f64,
    /// Standard deviation of a base angle (rad).
    angle_deviation: f64,
    /// The newest readings, oldest first.
    readings: [Posed; REMEMBERED],
    count: usize,
    /// Way of the whisker (m) since the newest of them.
    path: f64,
    /// The tip (m, world frame) at the last sample.
    tip: Option<Point2>,
    /// How far the fixed place is from the tip (m); 0 without one.
    apart: f64,
    /// How far off the tip may be (m) by what was before.
    doubt: f64,
    rest: Option<Rest>,
}

/// A place on which the shaft seems to rest.
#[derive(Debug, Clone, Copy)]
struct Rest {
    /// m, world frame.
    position: Point2,
    /// Judgements in a row, up to now, by which it explains the readings, and the most of them.
    lasted: usize,
    longest: usize,
    /// The doubt (m) without it.
    doubt_before: f64,
}

/// A base angle, and how the base stood.
#[derive(Debug, Clone, Copy, Default)]
struct Posed {
    /// m, world frame.
    base: Point2,
    /// Direction of the undeflected shaft.
    axis: Vector2,
    /// rad.
    angle: f64,
    /// Direction of the surface's normal by the estimate (rad, world frame).
    normal: f64,
}

/// Readings that one fixed place has to explain.
const REMEMBERED: usize = 4;
/// Way of the whisker (m) from one of them to the next.
const SPACING: f64 = 0.75e-3;
/// How far the mechanics may be off, as a share of the base angle, and the misfit in standard deviations that is still explained.
const MODEL_SHARE: f64 = 3e-3;
const MISFIT: f64 = 1.5;
/// The greatest standard deviation, as a share of the base angle, of readings that tell a rest: others fit many places.
const MOST_NOISE: f64 = 0.01;
/// By how much the surface seems to turn (rad) from the oldest to the newest of the readings, at least, if the shaft rests.
const LEAST_TURN: f64 = 0.03;
/// The least share of the shaft at which a corner is looked for, and the steps from there to the tip.
const LEAST_SHARE: f64 = 0.15;
const STEPS: i32 = 16;
/// Steps of the search for a place between two of these.
const REFINEMENTS: usize = 4;
/// How far a place may seem to move (m) if it is fixed: so far off it may be found.
const DRIFT: f64 = 1.5e-3;
/// Judgements in a row behind which a rest leaves a doubt, and behind which no later place speaks against it.
const LASTING: usize = 4;
const PROVEN: usize = 8;
/// Way of the tip (m) on which a doubt falls by a factor e.
const FADING: f64 = 12e-3;
/// How far off a tip may be (m) whose shaft lies along the surface.
const FLAT: f64 = 5e-3;

impl ShaftRest {
    pub(super) fn new(whisker: &Whisker, angle_deviation: f64) -> Self {
        Self {
            pivot: Pivot::new(whisker),
            length: whisker.shaft.length,
            angle_deviation,
            readings: [Posed::default(); REMEMBERED],
            count: 0,
            path: 0.0,
            tip: None,
            apart: 0.0,
            doubt: 0.0,
            rest: None,
        }
    }

    /// How far off the tip may be (m), as a standard deviation, because it may not be what touches.
    pub(super) fn doubt(&self) -> f64 {
        self.doubt.max(self.apart)
    }

    /// Forgets the readings at a gap in the contact. What was in doubt before stays so.
    pub(super) fn interrupt(&mut self) {
        (self.count, self.path, self.tip, self.apart, self.rest) = (0, 0.0, None, 0.0, None);
    }

    /// Forgets the contact.
    pub(super) fn end(&mut self) {
        self.interrupt();
        self.doubt = 0.0;
    }

    /// Takes a base angle (rad) with the base at `base`, `path` (m) after the last one. By the estimate the tip is at `tip` (m, world
    /// frame), on a surface whose normal has the direction `normal` (rad) from the undeflected shaft, for a bend to the left.
    pub(super) fn take(&mut self, angle: f64, base: Pose, path: f64, tip: Point2, normal: f64) {
        // An estimate that goes wrong may run ahead of the whisker.
        let slid = self.tip.replace(tip).map_or(0.0, |before| (tip - before).norm().min(path));
        let fading = (-slid / FADING).exp();
        self.doubt *= fading;
        if let Some(rest) = &mut self.rest {
            rest.doubt_before *= fading;
        }
        self.path += path;
        if self.count > 0 && self.path < SPACING {
            return;
        }
        self.path = 0.0;
        self.readings.rotate_left(1);
        self.readings[REMEMBERED - 1] = Posed {
            base: base.position,
            axis: unit(base.heading),
            angle,
            normal: base.heading + angle.signum() * normal,
        };
        self.count = (self.count + 1).min(REMEMBERED);
        if self.count == REMEMBERED {
            self.judge(tip);
            if self.seems_to_turn() && self.pivot.lies_flat(angle, normal) {
                self.doubt = self.doubt.max(FLAT);
                // A place that turns out to be no corner says nothing of this.
                if let Some(rest) = &mut self.rest {
                    rest.doubt_before = rest.doubt_before.max(FLAT);
                }
            }
        }
    }

    fn judge(&mut self, tip: Point2) {
        let Some(position) = self.fixed_position() else {
            self.apart = 0.0;
            if let Some(rest) = &mut self.rest {
                rest.lasted = 0;
            }
            return;
        };
        if let Some(moved) = self.rest.take_if(|rest| (position - rest.position).norm() > DRIFT)
            && moved.longest < PROVEN
        {
            self.doubt = moved.doubt_before;
        }
        let begun = Rest { position, lasted: 0, longest: 0, doubt_before: self.doubt };
        let rest = self.rest.get_or_insert(begun);
        rest.lasted += 1;
        rest.longest = rest.longest.max(rest.lasted);
        self.apart = (position - tip).norm();
        if rest.lasted >= LASTING {
            self.doubt = self.doubt.max(self.apart);
        }
    }

    /// The place (m, world frame) nearest to the base on which a shaft that rests has all the base angles.
    fn fixed_position(&self) -> Option<Point2> {
        let (oldest, newest) = (&self.readings[0], &self.readings[REMEMBERED - 1]);
        if self.angle_deviation > MOST_NOISE * newest.angle.abs() || !self.seems_to_turn() {
            return None;
        }
        // A place on the newest shaft, and by how much the oldest base angle is not that of a shaft on it.
        let tried = |share: f64| {
            let position = newest.to_world(self.pivot.contact_base(newest.angle, share * self.length)?);
            Some((position, self.misfit(oldest, position)?))
        };
        let shares = (0..=STEPS).map(|step| LEAST_SHARE + (1.0 - LEAST_SHARE) * f64::from(step) / f64::from(STEPS));
        let mut before: Option<(f64, f64)> = None;
        for share in shares {
            let last = before;
            before = tried(share).map(|(_, misfit)| (share, misfit));
            if let (Some(below), Some(above)) = (last, before)
                && below.1 * above.1 <= 0.0
                && let Some(position) = refined(tried, below, above)
                && self.explains(position)
            {
                return Some(position);
            }
        }
        None
    }

    /// Whether the surface seems to turn from the oldest to the newest reading. A tip that slides along a straight wall explains readings
    /// in which it does not.
    fn seems_to_turn(&self) -> bool {
        wrap(self.readings[REMEMBERED - 1].normal - self.readings[0].normal).abs() > LEAST_TURN
    }

    /// Whether a shaft that rests on a place (m, world frame) has all the base angles.
    fn explains(&self, position: Point2) -> bool {
        self.readings.iter().all(|reading| {
            let deviation = self.angle_deviation.hypot(MODEL_SHARE * reading.angle);
            self.misfit(reading, position).is_some_and(|misfit| misfit.abs() <= MISFIT * deviation)
        })
    }

    /// By how much (rad) the base angle of a shaft that rests on a place (m, world frame) is greater than that of a reading.
    fn misfit(&self, reading: &Posed, position: Point2) -> Option<f64> {
        Some(self.pivot.base_angle(reading.to_base(position))? - reading.angle)
    }
}

/// The place without a misfit between two shares of the shaft, each with its misfit.
fn refined(
    tried: impl Fn(f64) -> Option<(Point2, f64)>,
    mut below: (f64, f64),
    mut above: (f64, f64),
) -> Option<Point2> {
    let mut position = None;
    for _ in 0..REFINEMENTS {
        let share = below.0 + (above.0 - below.0) * below.1 / (below.1 - above.1);
        let (found, misfit) = tried(share)?;
        position = Some(found);
        if misfit * below.1 > 0.0 { below = (share, misfit) } else { above = (share, misfit) }
    }
    position
}

impl Posed {
    fn to_world(self, position: Vector2) -> Point2 {
        self.base + position.x * self.axis + position.y * perpendicular(self.axis)
    }

    fn to_base(self, position: Point2) -> Vector2 {
        let offset = position - self.base;
        Vector2::new(self.axis.dot(&offset), perpendicular(self.axis).dot(&offset))
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]

    use std::f64::consts::{FRAC_PI_2, PI};

    use proptest::prelude::*;

    use super::*;
    use crate::mechanics::Elastica;
    use crate::rig::Rig;

    fn rest() -> (ShaftRest, Whisker) {
        let whisker = Rig::default().whiskers.remove(0);
        (ShaftRest::new(&whisker, 4.5e-7), whisker)
    }

    /// Takes the base angle of a shaft that rests on a corner at `position` (m, world frame) with a share of its length, by the exact theory.
    /// The force is in units of `EI / L²`. What is taken for a surface turns by `turned` (rad).
    fn take_on_corner(
        rest: &mut ShaftRest,
        whisker: &Whisker,
        position: Point2,
        (share, force): (f64, f64),
        turned: f64,
    ) {
        let elastica = Elastica::new(whisker);
        let force_unit = whisker.shaft.bending_stiffness() / whisker.shaft.length.powi(2);
        let shape = elastica.under(share * whisker.shaft.length, FRAC_PI_2, force * force_unit).unwrap();
        let base = Pose { position: position - shape.contact_base, heading: 0.0 };
        let tip = base.position + shape.tip_base;
        rest.take(shape.base_angle, base, SPACING, tip, PI + turned);
    }

    proptest! {
        #[test]
        fn a_shaft_that_rests_on_a_corner_puts_its_tip_in_doubt(share in 0.4..0.85_f64, force in 1.0..3.0_f64, slide in 3e-3..8e-3_f64) {
            let (mut rest, whisker) = rest();
            for step in 0..10 {
                take_on_corner(&mut rest, &whisker, Point2::new(0.3, -0.2), (share + slide * f64::from(step), force), 0.02 * f64::from(step));
            }
            let beyond = (1.0 - share - 10.0 * slide) * whisker.shaft.length;
            prop_assert!(rest.doubt() > beyond, "{} m, {beyond} m beyond the corner", rest.doubt());
        }

        #[test]
        fn a_tip_that_slides_along_a_wall_is_not_in_doubt(lean in 0.4..1.0_f64, force in 0.5..1.5_f64) {
            let (mut rest, whisker) = rest();
            let elastica = Elastica::new(&whisker);
            let force_unit = whisker.shaft.bending_stiffness() / whisker.shaft.length.powi(2);
            let shape = elastica.under(whisker.shaft.length, FRAC_PI_2 + lean, force * force_unit).unwrap();
            // The wall is square to the force.
            let along = perpendicular(unit(shape.force_direction));
            for step in 0..40 {
                let base = Pose { position: Point2::origin() + SPACING * f64::from(step) * along, heading: 0.0 };
                rest.take(shape.base_angle, base, SPACING, base.position + shape.tip_base, shape.force_direction);
                prop_assert!(rest.doubt() < 1e-4, "{} m", rest.doubt());
            }
        }
    }

    #[test]
    fn a_shaft_that_lies_along_a_surface_that_seems_to_turn_puts_its_tip_in_doubt() {
        let (mut rest, _) = rest();
        for step in 0..4 {
            let normal = FRAC_PI_2 - 0.02 * f64::from(step);
            rest.take(1e-4, Pose::default(), SPACING, Point2::new(0.1, 0.0), normal);
        }
        assert!(rest.doubt() >= FLAT);
        rest.end();
        assert!(rest.doubt() < f64::EPSILON);
    }

    #[test]
    fn a_place_that_was_no_corner_leaves_a_shaft_in_doubt_that_lay_along_a_surface() {
        let (mut rest, whisker) = rest();
        // It lies along a surface while it seems to rest on one corner, and then it seems to rest on another.
        for (position, normal) in [(Point2::new(0.3, -0.2), FRAC_PI_2), (Point2::new(0.3, -0.19), PI)] {
            for step in 0..5 {
                let turned = normal - PI - 0.02 * f64::from(step);
                take_on_corner(&mut rest, &whisker, position, (0.9 + 5e-3 * f64::from(step), 2.0), turned);
            }
        }
        // Readings that no fixed place explains end the rest.
        for _ in 0..4 {
            rest.take(1e-4, Pose::default(), SPACING, Point2::new(0.1, 0.0), PI);
        }
        assert!(rest.doubt() > FLAT / 3.0, "{} m", rest.doubt());
    }
}
