//! Detection of a closed loop.

use std::collections::VecDeque;
use std::f64::consts::PI;

use crate::geometry::{Point2, Vector2, perpendicular, turn_between};
use crate::scene::LoopClosed;

/// Least rotation of the platform about a point for a closed loop (rad). It is a full turn minus a possible difference
/// of the platform's inclination to the surface. A tip that slides back has a rotation of zero, with the same
/// tolerance.
const MIN_ROTATION: f64 = PI;

/// Length of the outline along which the first tips are kept (m). A later tip near one of them closes the loop. The
/// very first tip alone is not sufficient: it may be next to a corner, or off the outline because the contact was new.
const START_LENGTH: f64 = 0.02;

/// Distance (m) between the two tips that give the direction of the outline.
const CHORD: f64 = 0.002;

/// Cosine of the largest angle between two normals on the same side of an object.
const SAME_SIDE: f64 = 0.5;

/// Limits for consecutive tips along the outline, in ticks (1) and distance (m). The score connects tips by the same
/// limits.
const MAX_MISSED_TICKS: usize = 3;
const MAX_STEP: f64 = 0.01;

/// Compares one whisker's tips with its first ones.
#[derive(Debug, Clone, Default)]
pub(super) struct LoopWatch {
    start: Option<Start>,
    /// The platform's bearing from the first tip (rad).
    bearing: f64,
    /// Rotation of that bearing since then (rad), counter-clockwise positive.
    rotation: f64,
    /// The newest consecutive tips, back to one [`CHORD`] behind.
    newest: VecDeque<Point2>,
    /// Ticks since the newest tip.
    missed: usize,
}

/// The start of a loop.
#[derive(Debug, Clone)]
struct Start {
    /// Time of the first tip (s).
    time: f64,
    /// The first tip (m, world frame).
    position: Point2,
    /// The first tips.
    tips: Vec<FirstTip>,
    /// Length of the outline along them (m).
    length: f64,
}

/// One of the first tips.
#[derive(Debug, Clone, Copy)]
struct FirstTip {
    /// Its position (m, world frame).
    position: Point2,
    /// Normal of the outline, towards the platform's side.
    normal: Vector2,
    /// Rotation of the platform about the very first tip up to this tip (rad).
    rotation: f64,
}

impl LoopWatch {
    /// Receives the tip of one tick, if there is one, and the position of the platform. Returns true if the tip closes
    /// the loop. Such a tip is near one of the first ones, on the same side of the object and late enough, and the
    /// platform has rotated about it since. A tip that slid back is also near the first ones, and so is a tip on the
    /// other side of a thin wall.
    pub(super) fn closes(&mut self, time: f64, tip: Option<Point2>, platform: Point2, aim: &LoopClosed) -> bool {
        let begun = tip.map(|position| Start { time, position, tips: Vec::new(), length: 0.0 });
        let Some(start) = self.start.take().or(begun) else { return false };
        let from_start = platform - start.position;
        let bearing = from_start.y.atan2(from_start.x);
        if time > start.time {
            self.rotation += turn_between(self.bearing, bearing);
        }
        self.bearing = bearing;
        let start = self.start.insert(start);
        let Some(tip) = tip else {
            self.missed += 1;
            return false;
        };

        let step = self.newest.back().map(|last| (tip - last).norm());
        let step = step.filter(|step| self.missed < MAX_MISSED_TICKS && *step <= MAX_STEP);
        self.missed = 0;
        if step.is_none() {
            self.newest.clear();
        }
        self.newest.push_back(tip);
        while self.newest.get(1).is_some_and(|next| (tip - next).norm() >= CHORD) {
            self.newest.pop_front();
        }
        let chord_start = self.newest.front().copied().unwrap_or(tip);
        let chord = tip - chord_start;
        if chord.norm() < CHORD {
            return false;
        }
        let left = perpendicular(chord.normalize());
        let normal = if left.dot(&(platform - tip)) < 0.0 { -left } else { left };
        if start.length <= START_LENGTH {
            let positions = if start.tips.is_empty() { vec![chord_start, tip] } else { vec![tip] };
            start.tips.extend(positions.into_iter().map(|position| FirstTip {
                position,
                normal,
                rotation: self.rotation,
            }));
            start.length += step.unwrap_or(0.0);
        }
        let is_back = |first: &FirstTip| {
            (tip - first.position).norm() <= aim.within
                && first.normal.dot(&normal) >= SAME_SIDE
                && (self.rotation - first.rotation).abs() >= MIN_ROTATION
        };
        time - start.time >= aim.after && start.tips.iter().any(is_back)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]
    use super::LoopWatch;
    use crate::geometry::{Point2, Vector2, perpendicular, polygon, rotate, unit};
    use crate::scene::LoopClosed;

    const AIM: LoopClosed = LoopClosed { within: 0.005, after: 2.0 };

    /// The time at which tips on a circle of 0.1 m close the loop. The angles are given tick by tick, and the platform
    /// is outside.
    fn closing_time(angles: impl Iterator<Item = f64>) -> Option<f64> {
        closing_time_with(&AIM, angles)
    }

    fn closing_time_with(aim: &LoopClosed, angles: impl Iterator<Item = f64>) -> Option<f64> {
        let mut watch = LoopWatch::default();
        let mut timed = angles.enumerate().map(|(tick, angle)| (tick as f64 * 0.1, unit(angle)));
        let closes = |&(time, outwards): &(f64, Vector2)| {
            watch.closes(time, Some(Point2::from(0.1 * outwards)), Point2::from(0.2 * outwards), aim)
        };
        timed.find(closes).map(|(time, _)| time)
    }

    #[test]
    fn a_tip_that_goes_round_closes_the_loop_either_way() {
        for direction in [1.0, -1.0] {
            let closing = closing_time((0..100).map(|tick| direction * 0.1 * f64::from(tick)));
            assert_eq!(closing.map(|time| (time * 10.0).round()), Some(63.0), "at a whole turn");
        }
    }

    /// Tips along a polygon, several times around, from 2 mm behind its first corner on. The platform is 0.1 m away,
    /// perpendicular to the outline except for a lean (rad) that depends on the distance along the path (m).
    fn round(corners: &[Point2], lean: impl Fn(f64) -> f64) -> impl Iterator<Item = (Point2, Point2)> {
        let contour = polygon(corners).unwrap();
        (0..1200).map(move |tick| {
            let distance = 0.0015 * f64::from(tick);
            let along = (0.002 + distance) % contour.length();
            let (tip, tangent) = (contour.point_at(along), contour.tangent_at(along));
            (tip, tip - 0.1 * rotate(perpendicular(tangent), lean(distance)))
        })
    }

    /// The distance along the path (m) after which these tips close the loop.
    fn closing_distance(corners: &[Point2], lean: impl Fn(f64) -> f64) -> Option<f64> {
        let mut watch = LoopWatch::default();
        let mut ticks = round(corners, lean).zip(0_u32..);
        let closing =
            ticks.find(|&((tip, platform), tick)| watch.closes(0.1 * f64::from(tick), Some(tip), platform, &AIM));
        closing.map(|(_, tick)| 0.0015 * f64::from(tick))
    }

    /// A wall 0.4 m long, its outline from the middle of one side on.
    fn wall(thickness: f64) -> [Point2; 5] {
        [(0.2, 0.0), (0.4, 0.0), (0.4, thickness), (0.0, thickness), (0.0, 0.0)].map(|(x, y)| Point2::new(x, y))
    }

    #[test]
    fn a_loop_that_begins_right_behind_a_sharp_corner_closes() {
        for degrees in [20.0_f64, 50.0, 70.0, 90.0, 120.0, 170.0] {
            // A rhombus with sides of 0.1 m and a corner of this angle.
            let (a, b) = (0.1 * unit(0.0), 0.1 * unit(degrees.to_radians()));
            let corners = [Point2::origin(), Point2::from(a), Point2::from(a + b), Point2::from(b)];
            let distance = closing_distance(&corners, |_| 0.0);
            assert!(
                distance.is_some_and(|distance| (distance - 0.4).abs() < 2.0 * AIM.within),
                "{degrees} deg: {distance:?}"
            );
        }
    }

    #[test]
    fn a_tip_behind_a_thin_wall_does_not_close_the_loop_and_one_that_comes_round_it_does() {
        for thickness in [0.0005, 0.002, 0.0045] {
            let distance = closing_distance(&wall(thickness), |_| 0.0);
            assert!(
                distance.is_some_and(|distance| (distance - 0.8).abs() < 3.0 * AIM.within),
                "{thickness} m: {distance:?}"
            );
        }
    }

    #[test]
    fn behind_a_thin_wall_no_lean_of_the_platform_closes_the_loop() {
        for lean in [0.4, 0.6, -0.6] {
            // With a lean to one side at first and to the other from then on, the platform rotates by up to 250 deg on
            // the way to the other side.
            let distance = closing_distance(&wall(0.002), |distance| if distance < 0.01 { -lean } else { lean });
            assert!(
                distance.is_some_and(|distance| (distance - 0.8).abs() < 3.0 * AIM.within),
                "{lean} rad: {distance:?}"
            );
        }
    }

    #[test]
    fn a_start_at_the_end_of_a_thin_wall_has_first_tips_on_both_sides() {
        // From 12 mm before the end on, so that the first 20 mm of the outline go round it.
        let [_, near, far, back, front] = wall(0.003);
        let distance = closing_distance(&[Point2::new(0.388, 0.0), near, far, back, front], |_| 0.0);
        assert!(distance.is_some_and(|distance| (distance - 0.806).abs() < 3.0 * AIM.within), "{distance:?}");
    }

    #[test]
    fn a_loop_closes_though_the_first_tip_was_wrong_by_centimetres() {
        let wrong = std::iter::once(-0.3);
        assert!(closing_time(wrong.chain((0..100).map(|tick| 0.1 * f64::from(tick)))).is_some());
    }

    #[test]
    fn a_tip_that_comes_back_the_way_it_went_does_not() {
        assert_eq!(closing_time((0..100).map(|tick| (0.1 * f64::from(tick)).sin())), None);
    }

    #[test]
    fn a_tip_that_stays_does_not() {
        assert_eq!(closing_time((0..100).map(|tick| 0.01 * (0.7 * f64::from(tick)).sin())), None);
    }

    #[test]
    fn a_tip_that_came_back_and_then_goes_round_does() {
        let back = (0..32).map(|tick| (0.1 * f64::from(tick)).sin());
        let closing = closing_time(back.chain((0..200).map(|tick| 0.1 * f64::from(tick))));
        assert!(closing.is_some_and(|time| time > 9.0), "{closing:?}");
    }

    #[test]
    fn a_loop_that_closes_too_early_goes_on_to_the_next_time_round() {
        let aim = LoopClosed { after: 10.0, ..AIM };
        let closing = closing_time_with(&aim, (0..300).map(|tick| 0.09 * f64::from(tick)));
        assert!(closing.is_some_and(|time| time >= aim.after), "{closing:?}");
    }
}
