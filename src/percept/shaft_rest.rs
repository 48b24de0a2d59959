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
    /// How far off the tip may be (m) by the rests before.
    doubt: f64,
    /// The fixed place (m, world frame), how far it is from the tip (m), and how many readings in a row it has explained.
    place: Option<Point2>,
    apart: f64,
    rested_for: usize,
    /// Whether the contact is too new to tell.
    is_new: bool,
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
/// Readings in a row behind which a rest leaves a doubt.
const LASTING: usize = 3;
/// Way of the tip (m) on which a doubt falls by a factor e.
const FADING: f64 = 11e-3;
/// How far a fixed place may seem to move (m) from reading to reading.
const DRIFT: f64 = 1.5e-3;

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
            doubt: 0.0,
            place: None,
            apart: 0.0,
            rested_for: 0,
            is_new: true,
        }
    }

    /// How far off the tip may be (m), as a standard deviation: up to all of the whisker while nothing is known.
    pub(super) fn doubt(&self) -> f64 {
        if self.is_new { self.length } else { self.doubt.max(self.apart) }
    }

    /// Forgets the readings at a gap in the contact. What was in doubt before stays so.
    pub(super) fn interrupt(&mut self) {
        (self.count, self.way, self.tip, self.is_new) = (0, 0.0, None, true);
        (self.place, self.apart, self.rested_for) = (None, 0.0, 0);
    }

    /// Forgets the contact.
    pub(super) fn end(&mut self) {
        self.interrupt();
        self.doubt = 0.0;
    }

    /// Takes a base angle (rad) with the base at `base`, `way` (m) after the last one, and the tip (m, world frame) as it is estimated.
    pub(super) fn take(&mut self, angle: f64, base: Pose, way: f64, tip: Point2) {
        let slid = self.tip.map_or(0.0, |before| (tip - before).norm());
        self.tip = Some(tip);
        self.doubt *= (-slid / FADING).exp();
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
        let place = self.fixed_place(tip);
        self.is_new = false;
        let Some(place) = place else {
            (self.place, self.apart, self.rested_for) = (None, 0.0, 0);
            return;
        };
        if self.place.is_none_or(|before| (place - before).norm() > DRIFT) {
            (self.place, self.rested_for) = (Some(place), 0);
        }
        self.rested_for += 1;
        self.apart = (place - tip).norm();
        if self.rested_for >= LASTING {
            self.doubt = self.doubt.max(self.apart);
        }
        if std::env::var_os("DBGREST").is_some() { eprintln!("REST {:.4} {:.4} angle {:.1} apart {:.2} for {} doubt {:.2}", tip.x, tip.y, 1e6*self.readings[REMEMBERED-1].angle, self.apart*1e3, self.rested_for, self.doubt*1e3); }
    }

    /// How far (m) the farthest fixed place that explains the readings is from the tip.
    fn fixed_place(&self, tip: Point2) -> Option<Point2> {
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
                && { if std::env::var_os("DBGREST").is_some() { eprintln!("ROOT {share:.3} {:.4} {:.4} tip {:.2} misfits {:?}", place.x, place.y, 1e3*(place-tip).norm(), self.readings.iter().map(|r| self.misfit(r, place).map(|m| (1e8*m).round()/1e2)).collect::<Vec<_>>()); } true }
                && self.explains(place)
            {
                return Some(place);
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
