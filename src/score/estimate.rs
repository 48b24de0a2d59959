//! The contour that a run estimates.

use rstar::RTree;
use rstar::primitives::Line;

use super::statistics::Statistics;
use super::tip::{valid_tips, whiskers};
use crate::geometry::{Point2, min_distance};
use crate::run::Trace;

/// How many ticks after a tip the next one of its stroke comes at the latest.
///
/// A whisker at the threshold of contact misses single ticks without having left the object, so two may be missing: a
/// tenth of a second at 30 Hz, after which the thesis calls a whisker detached.
pub const LONGEST_BREAK: usize = 3;

/// The greatest distance (m) between consecutive tips of a stroke.
///
/// At 50 mm/s and 30 Hz a tip moves by 1.7 mm a tick, and by 5 mm over the longest break. A step beyond twice that is a
/// jump of the estimate, or a touch elsewhere: nothing was traced between its ends.
pub const LONGEST_STEP: f64 = 0.01;

/// The estimated contour: the recorded tips of each whisker, in order, joined into strokes.
///
/// A stroke ends where the next tip comes later than [`LONGEST_BREAK`] or farther off than [`LONGEST_STEP`]. The tips of
/// different whiskers are never joined. A single tip is a stroke of its own.
#[derive(Debug, Clone)]
pub struct Estimate {
    strokes: Vec<Vec<Point2>>,
    lines: RTree<Line<[f64; 2]>>,
}

impl Estimate {
    /// The estimate of a run.
    #[must_use]
    pub fn new(trace: &Trace) -> Self {
        let strokes: Vec<_> = whiskers(trace).flat_map(|whisker| strokes(valid_tips(trace, whisker))).collect();
        let lines = strokes.iter().flat_map(|stroke| lines(stroke)).map(|(from, to)| Line::new(from.into(), to.into()));
        Self { lines: RTree::bulk_load(lines.collect()), strokes }
    }

    /// The strokes, whisker by whisker and in the order of time: polylines of at least one point (m, world frame).
    #[must_use]
    pub fn strokes(&self) -> &[Vec<Point2>] {
        &self.strokes
    }

    /// The mean distance (m) of its tips from another's strokes; `None` if either has none.
    #[must_use]
    pub fn apart(&self, other: &Self) -> Option<f64> {
        let distances: Option<Vec<f64>> = self.strokes.iter().flatten().map(|&tip| other.distance(tip)).collect();
        Some(Statistics::of(distances?)?.mean())
    }

    /// Distance (m) of a point from the nearest point of any stroke, in logarithmic time; `None` if there is no stroke.
    #[must_use]
    pub fn distance(&self, point: Point2) -> Option<f64> {
        let query = point.into();
        let distance = |line: &Line<[f64; 2]>| (point - Point2::from(line.nearest_point(&query))).norm();
        (self.lines.size() > 0).then(|| min_distance(&self.lines, point, f64::INFINITY, distance))
    }
}

fn strokes(tips: impl Iterator<Item = (usize, Point2)>) -> Vec<Vec<Point2>> {
    let mut strokes: Vec<Vec<Point2>> = Vec::new();
    let mut before: Option<(usize, Point2)> = None;
    for (tick, tip) in tips {
        let goes_on = before.is_some_and(|(last_tick, last_tip)| {
            tick - last_tick <= LONGEST_BREAK && (tip - last_tip).norm() <= LONGEST_STEP
        });
        match strokes.last_mut() {
            Some(stroke) if goes_on => stroke.push(tip),
            _ => strokes.push(vec![tip]),
        }
        before = Some((tick, tip));
    }
    strokes
}

/// The straight lines that a stroke is made of; a single tip is a line of no length.
fn lines(stroke: &[Point2]) -> impl Iterator<Item = (Point2, Point2)> {
    let single = if let [tip] = stroke { Some((*tip, *tip)) } else { None };
    stroke.windows(2).map(|ends| (ends[0], ends[1])).chain(single)
}
