//! Detection of shaft contacts where a tip contact is assumed.
//!
//! Why: docs/decisions/recorded-tips.md#a-tip-is-not-recorded-while-the-shaft-may-touch.

use crate::geometry::{Point2, Pose, Vector2, perpendicular, unit, wrap};
use crate::math;
use crate::mechanics::Pivot;
use crate::rig::Whisker;

/// Estimates the possible error of a tip because the shaft, not the tip, may be in contact.
///
/// A base angle fits a tip contact and contacts of the shaft alike. But a corner stays fixed while the base moves. If
/// one fixed position in the world explains the newest readings, the shaft may rest on a corner there. The possible
/// error of the tip is then the distance between the two. After the rest it decreases along the path on which the
/// errors of [`Sliding`](super::sliding::Sliding) decrease. A position that moves later was no corner and leaves no
/// error.
#[derive(Debug, Clone)]
pub(super) struct ShaftRest {
    pivot: Pivot,
    /// Length of the shaft (m).
    length: f64,
    /// Standard deviation of a base angle (rad).
    angle_deviation: f64,
    /// Newest readings, oldest first.
    readings: [PosedReading; REMEMBERED],
    /// Number of readings.
    count: usize,
    /// Path of the whisker (m) since the newest of them.
    path: f64,
    /// Tip at the last sample (m, world frame).
    tip: Option<Point2>,
    /// Distance of the fixed position from the tip (m), or 0 without one.
    offset: f64,
    /// Possible error (m) from earlier contacts of the shaft.
    possible_error: f64,
    /// The current rest, if any.
    rest: Option<Rest>,
}

/// A fixed position on which the shaft may rest.
#[derive(Debug, Clone, Copy)]
struct Rest {
    /// Position (m, world frame).
    position: Point2,
    /// Number of successive updates, up to now, in which it explains the readings, and the largest such number.
    lasted: usize,
    longest: usize,
    /// Possible error (m) without this rest.
    possible_error_before: f64,
}

/// A base angle with the pose of the base.
#[derive(Debug, Clone, Copy, Default)]
struct PosedReading {
    /// Position of the base (m, world frame).
    base: Point2,
    /// Direction of the undeflected shaft.
    axis: Vector2,
    /// Base angle (rad).
    angle: f64,
    /// Estimated direction of the surface normal (rad, world frame).
    normal: f64,
}

/// Number of readings that a fixed position must explain.
const REMEMBERED: usize = 4;
/// Path of the whisker (m) between these readings.
const SPACING: f64 = 0.75e-3;
/// Error of the mechanics as a share of the base angle, and the largest misfit in standard deviations that counts as
/// explained.
const MODEL_SHARE: f64 = 3e-3;
const MISFIT: f64 = 1.5;
/// Largest standard deviation of the readings, as a share of the base angle, for the detection of a rest. Noisier
/// readings fit many positions.
const MOST_NOISE: f64 = 0.01;
/// Smallest apparent rotation of the surface (rad) from the oldest to the newest reading if the shaft rests.
const LEAST_TURN: f64 = 0.03;
/// Smallest share of the shaft at which a corner is searched, and the number of steps from there to the tip.
const LEAST_SHARE: f64 = 0.15;
const STEPS: i32 = 16;
/// Steps of the refinement between two of these.
const REFINEMENTS: usize = 4;
/// Largest apparent motion (m) of a fixed position, due to its estimation error.
const DRIFT: f64 = 1.5e-3;
/// Number of successive updates after which a rest leaves a possible error, and after which a later position no longer
/// refutes it.
const LASTING: usize = 4;
const PROVEN: usize = 8;
/// Path of the tip (m) on which a possible error decreases by a factor e.
const FADING: f64 = 12e-3;
/// Possible error (m) of the tip of a shaft that lies along the surface.
const FLAT: f64 = 5e-3;
/// Path (m) of a tip after which it may be recorded, whatever may have touched before. The possible error has then decreased from
/// [`FLAT`] to the largest one of a recorded tip.
pub(crate) const SURE_AFTER: f64 = 38.7e-3;

impl ShaftRest {
    /// Creates the detection for `whisker`. `angle_deviation` (rad) is the standard deviation of a base angle.
    pub(super) fn new(whisker: &Whisker, angle_deviation: f64) -> Self {
        Self {
            pivot: Pivot::new(whisker),
            length: whisker.shaft.length,
            angle_deviation,
            readings: [PosedReading::default(); REMEMBERED],
            count: 0,
            path: 0.0,
            tip: None,
            offset: 0.0,
            possible_error: 0.0,
            rest: None,
        }
    }

    /// Sets the standard deviation (rad) of a base angle.
    pub(super) fn set_deviation(&mut self, angle_deviation: f64) {
        self.angle_deviation = angle_deviation;
    }

    /// Possible error of the tip (m), because the shaft may be in contact instead.
    pub(super) fn possible_error(&self) -> f64 {
        math::max(self.possible_error, self.offset)
    }

    /// Forgets the readings at a gap in the contact. Earlier possible errors remain.
    pub(super) fn interrupt(&mut self) {
        (self.count, self.path, self.tip, self.offset, self.rest) = (0, 0.0, None, 0.0, None);
    }

    /// Forgets the contact.
    pub(super) fn end(&mut self) {
        self.interrupt();
        self.possible_error = 0.0;
    }

    /// Adds a base angle (rad) with the base at `base`, `path` (m) after the last one. `tip` (m, world frame) is the
    /// estimated tip. `normal` is the estimated direction of the surface normal (rad) from the undeflected shaft, for a
    /// bend to the left.
    pub(super) fn take(&mut self, angle: f64, base: Pose, path: f64, tip: Point2, normal: f64) {
        // An incorrect estimate may move farther than the whisker.
        let slid = self.tip.replace(tip).map_or(0.0, |before| math::min((tip - before).norm(), path));
        let fading = math::exp(-slid / FADING);
        self.possible_error *= fading;
        if let Some(rest) = &mut self.rest {
            rest.possible_error_before *= fading;
        }
        self.path += path;
        if self.count > 0 && self.path < SPACING {
            return;
        }
        self.path = 0.0;
        self.readings.rotate_left(1);
        self.readings[REMEMBERED - 1] = PosedReading {
            base: base.position,
            axis: unit(base.heading),
            angle,
            normal: base.heading + angle.signum() * normal,
        };
        self.count = (self.count + 1).min(REMEMBERED);
        if self.count == REMEMBERED {
            self.update_rest(tip);
            if self.seems_to_turn() && self.pivot.lies_flat(angle, normal) {
                self.possible_error = math::max(self.possible_error, FLAT);
                // This error remains even if the position later proves to be no corner.
                if let Some(rest) = &mut self.rest {
                    rest.possible_error_before = math::max(rest.possible_error_before, FLAT);
                }
            }
        }
    }

    /// Updates the rest with the fixed position that explains the readings, if there is one.
    fn update_rest(&mut self, tip: Point2) {
        let Some(position) = self.fixed_position() else {
            self.offset = 0.0;
            if let Some(rest) = &mut self.rest {
                rest.lasted = 0;
            }
            return;
        };
        if let Some(moved) = self.rest.take_if(|rest| (position - rest.position).norm() > DRIFT)
            && moved.longest < PROVEN
        {
            self.possible_error = moved.possible_error_before;
        }
        let begun = Rest { position, lasted: 0, longest: 0, possible_error_before: self.possible_error };
        let rest = self.rest.get_or_insert(begun);
        rest.lasted += 1;
        rest.longest = rest.longest.max(rest.lasted);
        self.offset = (position - tip).norm();
        if rest.lasted >= LASTING {
            self.possible_error = math::max(self.possible_error, self.offset);
        }
    }

    /// The position (m, world frame) nearest to the base at which a resting shaft has all the base angles.
    fn fixed_position(&self) -> Option<Point2> {
        let (oldest, newest) = (&self.readings[0], &self.readings[REMEMBERED - 1]);
        if self.angle_deviation > MOST_NOISE * newest.angle.abs() || !self.seems_to_turn() {
            return None;
        }
        // A position on the newest shaft, and the misfit of the oldest base angle for a shaft that rests there.
        let candidate = |share: f64| {
            let position = newest.to_world(self.pivot.contact_base(newest.angle, share * self.length)?);
            Some((position, self.misfit(oldest, position)?))
        };
        let shares = (0..=STEPS).map(|step| LEAST_SHARE + (1.0 - LEAST_SHARE) * f64::from(step) / f64::from(STEPS));
        let mut before: Option<(f64, f64)> = None;
        for share in shares {
            let last = before;
            before = candidate(share).map(|(_, misfit)| (share, misfit));
            if let (Some(below), Some(above)) = (last, before)
                && below.1 * above.1 <= 0.0
                && let Some(position) = refined(candidate, below, above)
                && self.explains(position)
            {
                return Some(position);
            }
        }
        None
    }

    /// True if the surface apparently rotates from the oldest to the newest reading. Otherwise a tip that slides along
    /// a straight wall also explains the readings.
    fn seems_to_turn(&self) -> bool {
        wrap(self.readings[REMEMBERED - 1].normal - self.readings[0].normal).abs() > LEAST_TURN
    }

    /// True if a shaft that rests on a position (m, world frame) has all the base angles.
    fn explains(&self, position: Point2) -> bool {
        self.readings.iter().all(|reading| {
            let deviation = math::hypot(self.angle_deviation, MODEL_SHARE * reading.angle);
            self.misfit(reading, position).is_some_and(|misfit| misfit.abs() <= MISFIT * deviation)
        })
    }

    /// Difference (rad) between the base angle of a shaft that rests on a position (m, world frame) and that of a
    /// reading.
    fn misfit(&self, reading: &PosedReading, position: Point2) -> Option<f64> {
        Some(self.pivot.base_angle(reading.to_base(position))? - reading.angle)
    }
}

/// The position without a misfit between two shares of the shaft, each given with its misfit. It is found by the regula
/// falsi.
fn refined(
    candidate: impl Fn(f64) -> Option<(Point2, f64)>,
    mut below: (f64, f64),
    mut above: (f64, f64),
) -> Option<Point2> {
    let mut position = None;
    for _ in 0..REFINEMENTS {
        let share = below.0 + (above.0 - below.0) * below.1 / (below.1 - above.1);
        let (found, misfit) = candidate(share)?;
        position = Some(found);
        if misfit * below.1 > 0.0 { below = (share, misfit) } else { above = (share, misfit) }
    }
    position
}

impl PosedReading {
    /// Transforms a position in the frame of the base to the world frame.
    fn to_world(self, position: Vector2) -> Point2 {
        self.base + position.x * self.axis + position.y * perpendicular(self.axis)
    }

    /// Transforms a position in the world frame to the frame of the base.
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

    use super::super::sliding::MAX_POSSIBLE_ERROR;
    use super::*;
    use crate::mechanics::Elastica;
    use crate::rig::Rig;

    fn rest() -> (ShaftRest, Whisker) {
        let whisker = Rig::default().whiskers.remove(0);
        (ShaftRest::new(&whisker, 4.5e-7), whisker)
    }

    /// Adds the exact base angle of a shaft that rests on a corner at `position` (m, world frame) at a share of its
    /// length. The force is in units of `EI / L²`. The apparent surface rotates by `turned` (rad).
    fn take_on_corner(
        rest: &mut ShaftRest,
        whisker: &Whisker,
        position: Point2,
        (share, force): (f64, f64),
        turned: f64,
    ) {
        let elastica = Elastica::new(whisker);
        let force_unit = whisker.shaft.bending_stiffness() / math::square(whisker.shaft.length);
        let shape = elastica.under(share * whisker.shaft.length, FRAC_PI_2, force * force_unit).unwrap();
        let base = Pose { position: position - shape.contact_base, heading: 0.0 };
        let tip = base.position + shape.tip_base;
        rest.take(shape.base_angle, base, SPACING, tip, PI + turned);
    }

    proptest! {
        #[test]
        fn a_shaft_that_rests_on_a_corner_gives_a_possible_error(share in 0.4..0.85_f64, force in 1.0..3.0_f64, slide in 3e-3..8e-3_f64) {
            let (mut rest, whisker) = rest();
            for step in 0..10 {
                take_on_corner(&mut rest, &whisker, Point2::new(0.3, -0.2), (share + slide * f64::from(step), force), 0.02 * f64::from(step));
            }
            let beyond = (1.0 - share - 10.0 * slide) * whisker.shaft.length;
            prop_assert!(rest.possible_error() > beyond, "{} m, {beyond} m beyond the corner", rest.possible_error());
        }

        #[test]
        fn a_tip_that_slides_along_a_wall_has_no_possible_error(lean in 0.4..1.0_f64, force in 0.5..1.5_f64) {
            let (mut rest, whisker) = rest();
            let elastica = Elastica::new(&whisker);
            let force_unit = whisker.shaft.bending_stiffness() / math::square(whisker.shaft.length);
            let shape = elastica.under(whisker.shaft.length, FRAC_PI_2 + lean, force * force_unit).unwrap();
            // The wall is perpendicular to the force.
            let along = perpendicular(unit(shape.force_direction));
            for step in 0..40 {
                let base = Pose { position: Point2::origin() + SPACING * f64::from(step) * along, heading: 0.0 };
                rest.take(shape.base_angle, base, SPACING, base.position + shape.tip_base, shape.force_direction);
                prop_assert!(rest.possible_error() < 1e-4, "{} m", rest.possible_error());
            }
        }
    }

    #[test]
    fn a_tip_is_sure_after_the_path_on_which_the_largest_possible_error_fades() {
        let left = |path: f64| FLAT * math::exp(-path / FADING);
        assert!(left(SURE_AFTER) < MAX_POSSIBLE_ERROR && left(SURE_AFTER - 1e-3) > MAX_POSSIBLE_ERROR);
    }

    #[test]
    fn a_shaft_along_a_surface_that_seems_to_rotate_gives_a_possible_error() {
        let (mut rest, _) = rest();
        for step in 0..4 {
            let normal = FRAC_PI_2 - 0.02 * f64::from(step);
            rest.take(1e-4, Pose::default(), SPACING, Point2::new(0.1, 0.0), normal);
        }
        assert!(rest.possible_error() >= FLAT);
        rest.end();
        assert!(rest.possible_error() < f64::EPSILON);
    }

    #[test]
    fn a_refuted_corner_leaves_the_possible_error_of_a_shaft_that_lay_along_a_surface() {
        let (mut rest, whisker) = rest();
        // It lies along a surface while it seems to rest on one corner, and then it seems to rest on another.
        for (position, normal) in [(Point2::new(0.3, -0.2), FRAC_PI_2), (Point2::new(0.3, -0.19), PI)] {
            for step in 0..5 {
                let turned = normal - PI - 0.02 * f64::from(step);
                take_on_corner(&mut rest, &whisker, position, (0.9 + 5e-3 * f64::from(step), 2.0), turned);
            }
        }
        // Readings that no fixed position explains end the rest.
        for _ in 0..4 {
            rest.take(1e-4, Pose::default(), SPACING, Point2::new(0.1, 0.0), PI);
        }
        assert!(rest.possible_error() > FLAT / 3.0, "{} m", rest.possible_error());
    }
}
