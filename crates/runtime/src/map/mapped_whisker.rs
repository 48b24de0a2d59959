//! What a map keeps of a whisker.

use crate::geometry::Pose;
use crate::math;
use crate::percept::{MODEL_DEVIATION, Perception, TOLERATED_OFFSET};
use crate::rig::{Sensing, Whisker};

use super::cells::Cells;
use super::first_touch::FirstTouch;
use super::shaft_contact::{ShaftContact, ShaftFit};
use super::shaft_sweep::ShaftSweep;

/// Standard deviations of a reading within which a whisker reads straight. Of twenty successive readings at this bound,
/// half are beyond it, so a whisker that is bent by more is noticed.
const STRAIGHT: f64 = 10.0;
/// What the map keeps of a whisker.
#[derive(Debug, Clone)]
pub(super) struct MappedWhisker {
    /// Index in the policy.
    pub(super) index: usize,
    pub(super) sweep: ShaftSweep,
    mount: Pose,
    length: f64,
    fit: ShaftFit,
    /// Share of the path from the last pose to this one at which the mean reading of a tick was valid.
    mean_at: f64,
    /// Standard deviation of a mean reading over that of one reading.
    mean_deviation: f64,
    /// Base angle (rad) below which a reading is straight.
    straight: f64,
    /// Number of successive ticks, up to now, in which every reading was straight.
    straight_for: usize,
    touch: Option<Touch>,
}

/// A contact of a whisker.
#[derive(Debug, Clone, Copy)]
pub(super) struct Touch {
    /// The part of the shaft that may have touched first.
    pub(super) first: Option<FirstTouch>,
    /// The contact, if it is at a fixed place.
    pub(super) contact: Option<ShaftContact>,
    /// Number of successive ticks, up to now, in which the contact was one of the shaft at the same place.
    steady_for: u32,
}

/// Ticks for which a contact of the shaft must stay at its place, and the distance (m) by which it may move from tick to tick. One in
/// fifty sliding tips looks like a shaft for a tick, but not at one place.
const STEADY: u32 = 3;
const STEADY_WITHIN: f64 = 2e-3;

impl Touch {
    /// The contact, if it is one of the shaft and has been for some ticks.
    pub(super) fn steady_shaft(&self) -> Option<&ShaftContact> {
        self.contact.as_ref().filter(|_| self.steady_for >= STEADY)
    }
}

impl MappedWhisker {
    /// Creates it for a whisker as perception models it, with its index in the policy.
    pub(super) fn new(index: usize, whisker: &Whisker, sensing: &Sensing) -> Self {
        let period = sensing.control_rate.recip();
        let samples = math::max(sensing.sample_rate * period, 1.0);
        // The samples end with the tick, and a base angle is late by the delay of the hinge.
        let before = 0.5 * (samples - 1.0) / sensing.sample_rate + whisker.hinge.damping / whisker.hinge.stiffness;
        Self {
            index,
            sweep: ShaftSweep::new(whisker),
            mount: whisker.base_pose(),
            length: whisker.shaft.length,
            fit: ShaftFit::new(whisker),
            mean_at: 1.0 - before / period,
            mean_deviation: samples.sqrt().recip(),
            straight: 0.0,
            straight_for: 0,
            touch: None,
        }
    }

    /// Forgets the run and the contact: the pose is unknown.
    pub(super) fn interrupt(&mut self) {
        self.straight_for = 0;
        self.sweep.interrupt();
        self.end_touch();
    }

    fn end_touch(&mut self) {
        self.touch = None;
        self.fit.end();
    }

    /// The contact, if the whisker is bent.
    pub(super) fn touch(&self) -> Option<&Touch> {
        self.touch.as_ref()
    }

    /// The bound (rad) of the base angle of a whisker that has read straight for more than `waiting` ticks.
    pub(super) fn straight_below(&self, waiting: usize) -> Option<f64> {
        (self.straight_for > waiting).then_some(self.straight + TOLERATED_OFFSET)
    }

    /// The pose of the base with the body at `body`.
    fn base(&self, body: Pose) -> Pose {
        Pose { position: body.point_to_world(self.mount.position), heading: body.heading + self.mount.heading }
    }

    /// Follows a tick. `poses` are those of the body, the newest first, and a straight shaft waits for `waiting` of them.
    pub(super) fn follow(&mut self, perception: &Perception, poses: &[Pose], waiting: usize, cells: &Cells) {
        // Effects outside of the model limit the certainty of a sensor without noise.
        let deviation = math::hypot(perception.reading_deviation(self.index), MODEL_DEVIATION);
        self.straight = STRAIGHT * deviation;
        let is_straight = perception.largest_reading(self.index).is_some_and(|largest| largest < self.straight);
        self.straight_for = if is_straight { self.straight_for.saturating_add(1) } else { 0 };
        if !is_straight {
            self.sweep.interrupt();
        }
        let (now, before) =
            (poses.first().copied().unwrap_or(Pose::UNKNOWN), poses.get(1).copied().unwrap_or(Pose::UNKNOWN));
        let mean =
            perception.mean_reading(self.index).filter(|_| perception.is_touching(self.index) && before.is_finite());
        let Some(angle) = mean else { return self.end_touch() };
        let at_mean = Pose {
            position: before.position + self.mean_at * (now.position - before.position),
            heading: before.heading + self.mean_at * (now.heading - before.heading),
        };
        self.fit.take(angle, math::hypot(deviation * self.mean_deviation, MODEL_DEVIATION), self.base(at_mean));
        let first = if let Some(touch) = &self.touch {
            touch.first
        } else {
            let straight = poses.get(waiting).copied().filter(Pose::is_finite).unwrap_or(now);
            // A bend to the left is by an object on the right.
            FirstTouch::of(cells, self.base(straight), self.length, -angle.signum())
        };
        let contact = self.fit.contact();
        let last = self.touch.and_then(|touch| Some((touch.contact?.place, touch.steady_for)));
        let steady_for = match (contact.filter(|contact| contact.is_shaft), last) {
            (Some(contact), Some((place, steady_for))) if (contact.place - place).norm() < STEADY_WITHIN => {
                steady_for.saturating_add(1)
            }
            _ => 0,
        };
        self.touch = Some(Touch { first, contact, steady_for });
    }
}
