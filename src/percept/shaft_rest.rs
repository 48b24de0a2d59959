//! Whether it may be the shaft that touches, resting on a corner, where the tip is taken to touch.

use crate::geometry::{Point2, Pose, Vector2, perpendicular, unit};
use crate::mechanics::Pivot;
use crate::rig::Whisker;

/// Tells how far off a tip may be because the shaft rests on a corner instead.
///
/// One base angle fits a touch of the tip and touches of the shaft alike. But a corner stays where it is while the base moves: if one
/// fixed place in the world explains the newest readings, the shaft may rest there, and the tip is in doubt by the distance
/// between the two. A place that goes along with the tip is no corner. Behind a rest the doubt fades as the errors of
/// [`Sliding`](super::sliding::Sliding) do. A contact that is too new to tell is in doubt altogether.
#[derive(Debug, Clone)]
pub(super) struct ShaftRest {
    pivot: Pivot,
    /// Length of the shaft (m).
    length: f64,
    /// Standard deviation of a base angle (rad).
    angle_spread: f64,
    /// The newest readings, oldest first.
    readings: [Posed; REMEMBERED],
    count: usize,
    /// Way of the whisker (m) since the newest of them.
    way: f64,
    /// The tip (m, world frame) at the last sample.
    tip: Option<Point2>,
    /// How far off the tip may be (m); `None` while that is not known yet.
    doubt: Option<f64>,
    /// The tip (m, world frame) where a fixed place was last compared with it, and how far apart (m) the two were.
    anchor: Option<(Point2, f64)>,
    /// Whether the fixed place went along with the tip since then.
    goes_along: bool,
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
}

/// Readings that one fixed place has to explain.
const REMEMBERED: usize = 4;
/// Way of the whisker (m) from one of them to the next.
const SPACING: f64 = 0.75e-3;
/// How far the mechanics may be off, as a share of the base angle, and the misfit in standard deviations that is still explained.
const MODEL_SHARE: f64 = 3e-3;
const MISFIT: f64 = 1.5;
/// The least share of the shaft at which a corner is looked for, and the places that are tried.
const LEAST_SHARE: f64 = 0.15;
const PLACES: i32 = 16;
/// Steps of the search for a place between two of them.
const REFINEMENTS: usize = 4;
/// Way of the tip (m) on which a doubt falls by a factor e.
const FADING: f64 = 11e-3;
/// Way of the tip (m) on which a fixed place is compared with it, and the share of that by which the distance between the two changes
/// at least if the place is a corner.
const COMPARED: f64 = 1.5e-3;
const KEPT: f64 = 0.3;

impl ShaftRest {
    pub(super) fn new(whisker: &Whisker, angle_spread: f64) -> Self {
        Self {
            pivot: Pivot::new(whisker),
            length: whisker.shaft.length,
            angle_spread,
            readings: [Posed::default(); REMEMBERED],
            count: 0,
            way: 0.0,
            tip: None,
            doubt: None,
            anchor: None,
            goes_along: false,
        }
    }

    /// How far off the tip may be (m), as a standard deviation: up to all of the whisker while nothing is known.
    pub(super) fn doubt(&self) -> f64 {
        self.doubt.unwrap_or(self.length)
    }

    /// Forgets the contact.
    pub(super) fn interrupt(&mut self) {
        (self.count, self.way, self.tip, self.doubt) = (0, 0.0, None, None);
        (self.anchor, self.goes_along) = (None, false);
    }

    /// Takes a base angle (rad) with the base at `base`, `way` (m) after the last one, and the tip (m, world frame) as it is estimated.
    pub(super) fn take(&mut self, angle: f64, base: Pose, way: f64, tip: Point2) {
        let slid = self.tip.map_or(0.0, |before| (tip - before).norm());
        self.tip = Some(tip);
        self.doubt = self.doubt.map(|doubt| doubt * (-slid / FADING).exp());
        self.way += way;
        if self.count > 0 && self.way < SPACING {
            return;
        }
        self.way = 0.0;
        self.readings.rotate_left(1);
        self.readings[REMEMBERED - 1] = Posed { base: base.position, axis: unit(base.heading), angle };
        self.count = (self.count + 1).min(REMEMBERED);
        if self.count == REMEMBERED {
            self.judge(tip);
        }
    }

    fn judge(&mut self, tip: Point2) {
        let apart = self.fixed_place(tip);
        self.compare(tip, apart);
        let apart = apart.filter(|_| !self.goes_along);
        self.doubt = Some(self.doubt.unwrap_or(0.0).max(apart.unwrap_or(0.0)));
    }

    /// Notes whether the fixed place, so far apart (m) from the tip, goes along with it, as one on a wall that bends seems to.
    fn compare(&mut self, tip: Point2, apart: Option<f64>) {
        let Some(apart) = apart else {
            (self.anchor, self.goes_along) = (None, false);
            return;
        };
        let (tip_then, apart_then) = *self.anchor.get_or_insert((tip, apart));
        let slid = (tip - tip_then).norm();
        if slid > COMPARED {
            self.goes_along = (apart - apart_then).abs() < KEPT * slid;
            self.anchor = Some((tip, apart));
        }
    }

    /// How far (m) the farthest fixed place that explains the readings is from the tip.
    fn fixed_place(&self, tip: Point2) -> Option<f64> {
        let (newest, oldest) = (&self.readings[REMEMBERED - 1], &self.readings[0]);
        // A place on the newest shaft, and by how much the oldest base angle is not that of a shaft on it.
        let tried = |share: f64| {
            let place = newest.to_world(self.pivot.place(newest.angle, share * self.length)?);
            Some((place, self.misfit(oldest, place)?))
        };
        let step = (1.0 - LEAST_SHARE) / f64::from(PLACES);
        let mut before: Option<(f64, f64)> = None;
        for index in 0..=PLACES {
            let share = LEAST_SHARE + step * f64::from(index);
            let Some((_, misfit)) = tried(share) else {
                before = None;
                continue;
            };
            if let Some((from, from_misfit)) = before.replace((share, misfit))
                && from_misfit * misfit <= 0.0
                && let Some(place) = self.refined(&tried, (from, from_misfit), (share, misfit))
                && self.explains(place)
            {
                return Some((place - tip).norm());
            }
        }
        None
    }

    /// The place without a misfit between two shares of the shaft.
    fn refined(
        &self,
        tried: impl Fn(f64) -> Option<(Point2, f64)>,
        mut below: (f64, f64),
        mut above: (f64, f64),
    ) -> Option<Point2> {
        let mut place = None;
        for _ in 0..REFINEMENTS {
            let share = below.0 + (above.0 - below.0) * below.1 / (below.1 - above.1);
            let (found, misfit) = tried(share)?;
            place = Some(found);
            if misfit * below.1 > 0.0 { below = (share, misfit) } else { above = (share, misfit) }
        }
        place
    }

    /// Whether a shaft that rests on a place (m, world frame) has all the base angles.
    fn explains(&self, place: Point2) -> bool {
        self.readings.iter().rev().all(|reading| {
            let spread = self.angle_spread.hypot(MODEL_SHARE * reading.angle);
            self.misfit(reading, place).is_some_and(|misfit| misfit.abs() <= MISFIT * spread)
        })
    }

    /// By how much (rad) the base angle of a shaft that rests on a place (m, world frame) is greater than that of a reading.
    fn misfit(&self, reading: &Posed, place: Point2) -> Option<f64> {
        Some(self.pivot.base_angle(reading.to_base(place))? - reading.angle)
    }
}

impl Posed {
    fn to_world(self, place: Vector2) -> Point2 {
        self.base + place.x * self.axis + place.y * perpendicular(self.axis)
    }

    fn to_base(self, place: Point2) -> Vector2 {
        let offset = place - self.base;
        Vector2::new(self.axis.dot(&offset), perpendicular(self.axis).dot(&offset))
    }
}
