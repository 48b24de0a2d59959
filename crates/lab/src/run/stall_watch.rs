//! Detection of a run without progress.

use std::collections::HashMap;

use vibrissa_runtime::signal::MAX_WHISKERS;
use vibrissa_world::geometry::Point2;
use vibrissa_world::scene::Stalled;

use super::trace::TickRecord;

/// Detects progress: the platform or a recorded tip reaches a new position.
#[derive(Debug)]
pub(super) struct StallWatch {
    limit: Stalled,
    body: Positions,
    tips: [Positions; MAX_WHISKERS],
    /// Time of the last progress (s).
    newest: f64,
}

impl StallWatch {
    pub(super) fn new(limit: Stalled) -> Self {
        Self { limit, body: Positions::default(), tips: Default::default(), newest: 0.0 }
    }

    /// Receives a tick. Returns the reason if the run has stalled.
    pub(super) fn stalls(&mut self, tick: &TickRecord) -> Option<String> {
        let Stalled { within, after } = self.limit;
        let mut is_new = self.body.add(tick.body.position, within);
        for (positions, whisker) in self.tips.iter_mut().zip(&tick.whiskers) {
            is_new |= whisker.tip.is_some_and(|tip| positions.add(tip, within));
        }
        if is_new {
            self.newest = tick.time;
        }
        (tick.time - self.newest >= after).then(|| {
            let millimetres = within * 1e3;
            format!("no progress for {after} s: neither the platform nor a recorded tip moved {millimetres} mm away from its earlier positions")
        })
    }
}

/// Positions by the squares of a grid.
#[derive(Debug, Default)]
struct Positions(HashMap<(i64, i64), Vec<Point2>>);

impl Positions {
    /// Adds a position if it is farther than `within` (m) from all earlier ones. Returns true if it is.
    fn add(&mut self, position: Point2, within: f64) -> bool {
        if !(position.x.is_finite() && position.y.is_finite()) {
            return false;
        }
        #[expect(clippy::cast_possible_truncation, reason = "positions that far away share a square")]
        let (column, row) = ((position.x / within).floor() as i64, (position.y / within).floor() as i64);
        let around = |square: i64| [square.saturating_sub(1), square, square.saturating_add(1)];
        let mut squares = around(column).into_iter().flat_map(|x| around(row).map(|y| (x, y)));
        let is_known = squares.any(|square| {
            let positions = self.0.get(&square);
            positions.is_some_and(|positions| positions.iter().any(|known| (position - known).norm() <= within))
        });
        if !is_known {
            self.0.entry((column, row)).or_default().push(position);
        }
        !is_known
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::WhiskerRecord;
    use vibrissa_runtime::signal::Command;
    use vibrissa_world::geometry::{Pose, Vector2, unit};

    const LIMIT: Stalled = Stalled { within: 0.02, after: 10.0 };

    /// The time (s) at which a run stalls with these positions of the platform and these tips, ten a second.
    fn given_up(ticks: impl Iterator<Item = (Point2, Option<Point2>)>) -> Option<f64> {
        let mut watch = StallWatch::new(LIMIT);
        let mut ticks = ticks.enumerate().map(|(index, (position, tip))| TickRecord {
            time: index as f64 * 0.1,
            body: Pose { position, heading: 0.0 },
            state: None,
            whiskers: Box::new([WhiskerRecord { tip, ..WhiskerRecord::default() }]),
            command: Command { velocity_world: Vector2::zeros(), yaw_rate: 0.0 },
            fallback: None,
            body_touches: false,
        });
        ticks.find(|tick| watch.stalls(tick).is_some()).map(|tick| tick.time)
    }

    fn circle(radius: f64, index: u32) -> Point2 {
        Point2::from(radius * unit(0.05 * f64::from(index)))
    }

    #[test]
    fn a_platform_that_stays_is_given_up() {
        assert_eq!(given_up((0..500).map(|_| (Point2::origin(), None))), Some(10.0));
    }

    #[test]
    fn a_platform_that_goes_on_is_not() {
        assert_eq!(given_up((0..2000).map(|k| (Point2::new(0.0025 * f64::from(k), 0.0), None))), None);
    }

    #[test]
    fn a_tip_that_goes_on_is_progress_where_the_platform_stays() {
        assert_eq!(
            given_up((0..1000).map(|k| (Point2::origin(), Some(Point2::new(0.0025 * f64::from(k), 0.0))))),
            None
        );
    }

    #[test]
    fn going_round_in_circles_is_none_in_the_air_or_along_what_has_been_traced() {
        // A turn takes 12.6 s.
        for tip in [None, Some(0.3)] {
            let ticks = (0..1000).map(|k| (circle(0.2, k), tip.map(|radius| circle(radius, k))));
            let time = given_up(ticks);
            assert!(time.is_some_and(|time| (22.0..23.0).contains(&time)), "{time:?}");
        }
    }

    #[test]
    fn places_that_are_no_numbers_are_nowhere_new() {
        let nowhere = Point2::new(f64::NAN, f64::INFINITY);
        assert_eq!(given_up((0..500).map(|_| (nowhere, Some(nowhere)))), Some(10.0));
    }
}
