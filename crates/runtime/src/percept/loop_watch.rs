//! Detection of a closed loop.
//!
//! Why: docs/decisions/scores.md#loops-close-on-estimates-verdicts-on-exact-geometry.

use std::f64::consts::PI;

use crate::geometry::{Point2, Vector2, turn_between};
use crate::math;

/// Least rotation of the platform about a point for a closed loop (rad). It is a full turn minus a possible difference
/// of the platform's inclination to the surface. A tip that slides back has a rotation of zero, with the same
/// tolerance.
const MIN_ROTATION: f64 = PI;

/// Length of the outline along which the first tips are kept (m). A later tip near one of them closes the loop. The
/// very first tip alone is not sufficient: it may be next to a corner, or off the outline because the contact was new.
const START_LENGTH: f64 = 0.02;
/// Least distance (m) of two kept first tips, and space for all of them.
const FIRST_DISTANCE: f64 = START_LENGTH / 40.0;
const FIRST_CAPACITY: usize = 44;

/// Distance (m) between the two tips that give the direction of the outline.
const CHORD: f64 = 0.002;
/// Least distance (m) of two kept newest tips, and space for them.
const NEWEST_DISTANCE: f64 = CHORD / 20.0;
const NEWEST_CAPACITY: usize = 32;

/// Cosine of the largest angle between two normals on the same side of an object.
const SAME_SIDE: f64 = 0.5;

/// Limits for consecutive tips along the outline, in ticks (1) and distance (m). The score connects tips by the same
/// limits.
const MAX_MISSED_TICKS: usize = 3;
const MAX_STEP: f64 = 0.01;

/// Compares one whisker's recorded tips with its first ones.
///
/// A loop is closed by a tip near one of the first ones, on the same side of the object and late enough, if the
/// platform has rotated about it since. A tip that slid back is also near the first ones, and so is a tip on the other
/// side of a thin wall. The memory is bounded.
#[derive(Debug, Clone)]
pub struct LoopWatch {
    start: Option<Start>,
    /// The platform's bearing from the first tip (rad).
    bearing: f64,
    /// Rotation of that bearing since then (rad), counter-clockwise positive.
    rotation: f64,
    /// The last tip.
    last: Point2,
    /// The newest consecutive tips, back to one [`CHORD`] behind.
    newest: Kept<Point2, NEWEST_CAPACITY>,
    /// Ticks since the newest tip.
    missed: usize,
    /// The first tips.
    first: Kept<FirstTip, FIRST_CAPACITY>,
    /// The tip of the last tick.
    current: Option<Current>,
}

/// The start of a loop.
#[derive(Debug, Clone, Copy)]
struct Start {
    /// Time of the first tip (s).
    time: f64,
    /// The first tip (m, world frame).
    position: Point2,
    /// Length of the outline along the first tips (m).
    length: f64,
}

/// One of the first tips.
#[derive(Debug, Clone, Copy, Default)]
struct FirstTip {
    /// Its position (m, world frame).
    position: Point2,
    /// Normal of the outline, towards the platform's side.
    normal: Vector2,
    /// Rotation of the platform about the very first tip up to this tip (rad).
    rotation: f64,
}

/// A tip that may close the loop.
#[derive(Debug, Clone, Copy)]
struct Current {
    /// Time since the first tip (s).
    since: f64,
    tip: Point2,
    normal: Vector2,
}

/// A bounded list.
#[derive(Debug, Clone)]
struct Kept<T, const N: usize> {
    items: [T; N],
    count: usize,
}

impl<T: Copy + Default, const N: usize> Kept<T, N> {
    fn new() -> Self {
        Self { items: [T::default(); N], count: 0 }
    }

    fn items(&self) -> &[T] {
        &self.items[..self.count]
    }

    /// Adds an item. The oldest one is dropped if there is no space.
    fn push(&mut self, item: T) {
        if self.count == N {
            self.drop_first();
        }
        self.items[self.count] = item;
        self.count += 1;
    }

    fn drop_first(&mut self) {
        self.items[..self.count].rotate_left(1);
        self.count -= 1;
    }
}

impl Default for LoopWatch {
    fn default() -> Self {
        Self {
            start: None,
            bearing: 0.0,
            rotation: 0.0,
            last: Point2::origin(),
            newest: Kept::new(),
            missed: 0,
            first: Kept::new(),
            current: None,
        }
    }
}

impl LoopWatch {
    /// Receives the time of a tick (s), its recorded tip if there is one, and the position of the platform (m, world
    /// frame). Without a pose, the tick counts as one without a tip.
    pub fn update(&mut self, time: f64, tip: Option<Point2>, platform: Point2) {
        self.current = None;
        let has_pose = platform.coords.iter().all(|coordinate| coordinate.is_finite());
        let tip = tip.filter(|_| has_pose);
        let begun = tip.map(|position| Start { time, position, length: 0.0 });
        let Some(start) = self.start.or(begun) else { return };
        if has_pose {
            let from_start = platform - start.position;
            let bearing = math::atan2(from_start.y, from_start.x);
            if time > start.time {
                self.rotation += turn_between(self.bearing, bearing);
            }
            self.bearing = bearing;
        }
        let start = self.start.insert(start);
        let Some(tip) = tip else {
            self.missed += 1;
            return;
        };

        let step = (self.newest.count > 0).then(|| (tip - self.last).norm());
        let step = step.filter(|step| self.missed < MAX_MISSED_TICKS && *step <= MAX_STEP);
        (self.missed, self.last) = (0, tip);
        if step.is_none() {
            self.newest.count = 0;
        }
        if self.newest.items().last().is_none_or(|last| (tip - last).norm() >= NEWEST_DISTANCE) {
            self.newest.push(tip);
        }
        while self.newest.items().get(1).is_some_and(|next| (tip - next).norm() >= CHORD) {
            self.newest.drop_first();
        }
        let chord_start = self.newest.items().first().copied().unwrap_or(tip);
        let chord = tip - chord_start;
        if chord.norm() < CHORD {
            return;
        }
        let along = chord.normalize();
        let left = Vector2::new(-along.y, along.x);
        let normal = if left.dot(&(platform - tip)) < 0.0 { -left } else { left };
        if start.length <= START_LENGTH {
            start.length += step.unwrap_or(0.0);
            let rotation = self.rotation;
            let is_first = self.first.count == 0;
            for position in is_first.then_some(chord_start).into_iter().chain([tip]) {
                let last = self.first.items().last();
                if last.is_none_or(|last| (position - last.position).norm() >= FIRST_DISTANCE) {
                    self.first.push(FirstTip { position, normal, rotation });
                }
            }
        }
        self.current = Some(Current { since: time - start.time, tip, normal });
    }

    /// True if the tip of the last tick closes the loop. It is within a distance `within` (m) of one of the first tips,
    /// and at least the time `after` (s) after the first one.
    #[must_use]
    pub fn is_closed(&self, within: f64, after: f64) -> bool {
        let Some(Current { since, tip, normal }) = self.current else { return false };
        let is_back = |first: &FirstTip| {
            (tip - first.position).norm() <= within
                && first.normal.dot(&normal) >= SAME_SIDE
                && (self.rotation - first.rotation).abs() >= MIN_ROTATION
        };
        since >= after && self.first.items().iter().any(is_back)
    }
}
