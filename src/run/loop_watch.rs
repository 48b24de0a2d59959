//! When a whisker has gone all the way round.

use std::f64::consts::PI;

use crate::geometry::{Point2, turn_between};
use crate::scene::LoopClosed;

/// How far the platform has gone round the first tip (rad) when it has gone all the way round. Behind a wall, however thin, it has
/// gone half round at most; where a tip comes back to a sharp corner right behind which the first one was, what the corner turns is
/// still missing.
const ROUND: f64 = 1.25 * PI;

/// Watches one whisker's tips for their coming round to where the first one was.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct LoopWatch {
    start: Option<Start>,
    /// The platform's bearing from the first tip (rad).
    bearing: f64,
    /// How far that has turned since (rad), counter-clockwise.
    turned: f64,
}

/// Time (s) and place of the first tip.
#[derive(Debug, Clone, Copy)]
struct Start {
    time: f64,
    place: Point2,
}

impl LoopWatch {
    /// Takes the tip of one tick, if there is one, and where the platform is. Says whether the tip closes the loop: it is near the
    /// first one, late enough, and the platform has gone round that. A tip that slid back is near the first one too, and so is one
    /// on the other side of a thin wall.
    pub(super) fn closes(&mut self, time: f64, tip: Option<Point2>, platform: Point2, aim: &LoopClosed) -> bool {
        let Some(start) = self.start.or_else(|| tip.map(|place| Start { time, place })) else { return false };
        let from_start = platform - start.place;
        let bearing = from_start.y.atan2(from_start.x);
        if self.start.replace(start).is_some() {
            self.turned += turn_between(self.bearing, bearing);
        }
        self.bearing = bearing;
        let is_near = tip.is_some_and(|tip| (tip - start.place).norm() <= aim.within);
        is_near && self.turned.abs() >= ROUND && time - start.time >= aim.after
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]
    use super::LoopWatch;
    use crate::geometry::{Point2, Vector2, perpendicular, polygon, unit};
    use crate::scene::LoopClosed;

    const AIM: LoopClosed = LoopClosed { within: 0.005, after: 2.0 };

    /// The time at which tips along a circle of 0.1 m, at the angles given tick by tick, close the loop; the platform is outside.
    fn closing_time(angles: impl Iterator<Item = f64>) -> Option<f64> {
        let mut watch = LoopWatch::default();
        let mut timed = angles.enumerate().map(|(tick, angle)| (tick as f64 * 0.1, unit(angle)));
        let closes = |&(time, outwards): &(f64, Vector2)| {
            watch.closes(time, Some(Point2::from(0.1 * outwards)), Point2::from(0.2 * outwards), &AIM)
        };
        timed.find(closes).map(|(time, _)| time)
    }

    #[test]
    fn a_tip_that_goes_round_closes_the_loop_either_way() {
        for way in [1.0, -1.0] {
            let closing = closing_time((0..100).map(|tick| way * 0.1 * f64::from(tick)));
            assert_eq!(closing.map(|time| (time * 10.0).round()), Some(63.0), "at a whole turn");
        }
    }

    /// Tips all round a polygon, again and again, from 2 mm behind its first corner on, with the platform 0.1 m away from them.
    fn round(corners: &[Point2]) -> impl Iterator<Item = (Point2, Point2)> {
        let contour = polygon(corners).unwrap();
        (0..1200).map(move |tick| {
            let way = (0.002 + 0.0015 * f64::from(tick)) % contour.length();
            let (tip, along) = (contour.point_at(way), contour.tangent_at(way));
            (tip, tip - 0.1 * perpendicular(along))
        })
    }

    /// The way (m) after which those close the loop.
    fn closing_way(corners: &[Point2]) -> Option<f64> {
        let mut watch = LoopWatch::default();
        let mut ticks = round(corners).zip(0_u32..);
        let closing =
            ticks.find(|&((tip, platform), tick)| watch.closes(0.1 * f64::from(tick), Some(tip), platform, &AIM));
        closing.map(|(_, tick)| 0.0015 * f64::from(tick))
    }

    #[test]
    fn a_loop_that_begins_right_behind_a_sharp_corner_closes() {
        for degrees in [20.0_f64, 50.0, 70.0, 90.0, 120.0, 170.0] {
            // A rhombus with sides of 0.1 m and a corner of this angle.
            let (a, b) = (0.1 * unit(0.0), 0.1 * unit(degrees.to_radians()));
            let way = closing_way(&[Point2::origin(), Point2::from(a), Point2::from(a + b), Point2::from(b)]);
            assert!(way.is_some_and(|way| (way - 0.4).abs() < 2.0 * AIM.within), "{degrees} deg: {way:?}");
        }
    }

    #[test]
    fn a_tip_behind_a_thin_wall_does_not_close_the_loop_and_one_that_comes_round_it_does() {
        for thickness in [0.0005, 0.002, 0.0045] {
            let end = [Point2::new(0.4, 0.0), Point2::new(0.4, thickness)];
            let way =
                closing_way(&[Point2::new(0.2, 0.0), end[0], end[1], Point2::new(0.0, thickness), Point2::origin()]);
            assert!(way.is_some_and(|way| (way - 0.8).abs() < 3.0 * AIM.within), "{thickness} m: {way:?}");
        }
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
        let closing = closing_time((0..200).map(|tick| 0.4 * f64::from(tick)));
        assert!(closing.is_some_and(|time| time >= AIM.after));
    }
}
