//! When a whisker has gone all the way round.

use crate::geometry::{Point2, Vector2};
use crate::scene::LoopClosed;

/// The cosine of the greatest angle between the departure and a way that counts as ahead. Right behind a sharp corner the
/// whisker comes round at less than a right angle to its departure; one that slid back comes along the departure.
const AHEAD: f64 = std::f64::consts::FRAC_1_SQRT_2;

/// Watches one whisker's tips for their coming round to where the first one was.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct LoopWatch {
    start: Option<Start>,
    /// From the first tip to the first that was far from it.
    departure: Option<Vector2>,
    /// Whether the newest tip that was far from the start was ahead of it, as the departure went, or behind.
    ahead: bool,
    /// Whether there has been a tip near the start since.
    near: bool,
    /// Times that the tips passed the start the way of the departure, less those that they passed it the other way.
    passes: i32,
}

/// Time (s) and place of the first tip.
#[derive(Debug, Clone, Copy)]
struct Start {
    time: f64,
    place: Point2,
}

impl LoopWatch {
    /// Takes the tip of one tick, if there is one, and says whether it closes the loop: it is near the first one, late
    /// enough, and has come there all the way round. A tip that slid back is near the first one too.
    pub(super) fn closes(&mut self, time: f64, tip: Option<Point2>, aim: &LoopClosed) -> bool {
        let Some(tip) = tip else { return false };
        let start = *self.start.get_or_insert(Start { time, place: tip });
        let from_start = tip - start.place;
        let distance = from_start.norm();
        if distance > 2.0 * aim.within {
            let is_first = self.departure.is_none();
            let departure = *self.departure.get_or_insert(from_start);
            let ahead = departure.dot(&from_start) > AHEAD * departure.norm() * distance;
            if self.near && !is_first {
                self.passes += i32::from(ahead) - i32::from(self.ahead);
            }
            (self.ahead, self.near) = (ahead, false);
            return false;
        }
        self.near |= distance <= aim.within;
        let comes_round = self.departure.is_some() && !self.ahead && self.passes == 0;
        comes_round && distance <= aim.within && time - start.time >= aim.after
    }
}

#[cfg(test)]
mod tests {
    use super::LoopWatch;
    use crate::geometry::{Point2, unit};
    use crate::scene::LoopClosed;

    const AIM: LoopClosed = LoopClosed { within: 0.005, after: 2.0 };

    /// The time at which tips along a circle of 0.1 m, at the angles given tick by tick, close the loop.
    fn closing_time(angles: impl Iterator<Item = f64>) -> Option<f64> {
        let mut watch = LoopWatch::default();
        let mut timed = angles.enumerate().map(|(tick, angle)| (tick as f64 * 0.1, Point2::from(0.1 * unit(angle))));
        timed.find(|&(time, tip)| watch.closes(time, Some(tip), &AIM)).map(|(time, _)| time)
    }

    #[test]
    fn a_tip_that_goes_round_closes_the_loop_either_way() {
        for way in [1.0, -1.0] {
            let closing = closing_time((0..100).map(|tick| way * 0.1 * f64::from(tick)));
            assert_eq!(closing.map(|time| (time * 10.0).round()), Some(63.0), "at a whole turn");
        }
    }

    /// The tips along a rhombus with sides of 0.1 m and a corner of `angle` (rad), from 2 mm behind that corner on.
    fn round_a_rhombus(angle: f64) -> impl Iterator<Item = Point2> {
        let (a, b) = (0.1 * unit(0.0), 0.1 * unit(angle));
        let at = move |way: f64| match way.rem_euclid(0.4) {
            way if way < 0.1 => way / 0.1 * a,
            way if way < 0.2 => a + (way - 0.1) / 0.1 * b,
            way if way < 0.3 => b + (0.3 - way) / 0.1 * a,
            way => (0.4 - way) / 0.1 * b,
        };
        (0..600).map(move |tick| Point2::from(at(0.002 + 0.0015 * f64::from(tick))))
    }

    #[test]
    fn a_loop_that_begins_right_behind_a_sharp_corner_closes() {
        for degrees in [50.0_f64, 70.0, 90.0, 120.0, 170.0] {
            let mut watch = LoopWatch::default();
            let mut tips = round_a_rhombus(degrees.to_radians()).zip(0_u32..);
            let closing = tips.find(|&(tip, tick)| watch.closes(0.1 * f64::from(tick), Some(tip), &AIM));
            let way = closing.map(|(_, tick)| 0.0015 * f64::from(tick));
            assert!(way.is_some_and(|way| (way - 0.4).abs() < 2.0 * AIM.within), "{degrees} deg: {way:?}");
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
