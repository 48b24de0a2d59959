//! The estimated contour of a run.

use rstar::RTree;
use rstar::primitives::Line;

use super::statistics::Statistics;
use super::tip::{valid_tips, whiskers};
use crate::run::Trace;
use vibrissa_world::geometry::{Point2, min_distance};

/// The largest number of ticks between consecutive tips of a stroke.
///
/// A whisker near the contact threshold misses single ticks without loss of contact. Therefore two ticks may be
/// missing. This is a tenth of a second at 30 Hz, after which the baseline considers a whisker detached.
pub const MAX_BREAK: usize = 3;

/// The largest distance (m) between consecutive tips of a stroke.
///
/// At 50 mm/s and 30 Hz, a tip moves by 1.7 mm per tick, and by 5 mm over the longest break. A distance of more than
/// twice that is an outlier or another contact. Nothing was traced between its ends.
pub const MAX_STEP: f64 = 0.01;

/// The estimated contour: the recorded tips of each whisker, in order, joined into strokes.
///
/// A stroke ends if the next tip is later than [`MAX_BREAK`] or farther than [`MAX_STEP`]. Tips of different
/// whiskers are never joined. A single tip is a stroke of its own.
#[derive(Debug, Clone)]
pub struct Estimate {
    strokes: Vec<Vec<Point2>>,
    lines: RTree<Line<[f64; 2]>>,
}

impl Estimate {
    /// The estimated contour of a run.
    #[must_use]
    pub fn new(trace: &Trace) -> Self {
        let strokes: Vec<_> = whiskers(trace).flat_map(|whisker| strokes(valid_tips(trace, whisker))).collect();
        let lines = strokes.iter().flat_map(|stroke| lines(stroke)).map(|(from, to)| Line::new(from.into(), to.into()));
        Self { lines: RTree::bulk_load(lines.collect()), strokes }
    }

    /// The strokes, by whisker and time, as polylines of at least one point (m, world frame).
    #[must_use]
    pub fn strokes(&self) -> &[Vec<Point2>] {
        &self.strokes
    }

    /// The mean distance (m) of the tips from another estimate's strokes. `None` if either has none.
    #[must_use]
    pub fn mean_distance(&self, other: &Self) -> Option<f64> {
        let distances: Option<Vec<f64>> = self.strokes.iter().flatten().map(|&tip| other.distance(tip)).collect();
        Some(Statistics::of(distances?)?.mean())
    }

    /// The distance (m) of a point from the nearest stroke, in logarithmic time. `None` without strokes.
    #[must_use]
    pub fn distance(&self, point: Point2) -> Option<f64> {
        (self.lines.size() > 0)
            .then(|| min_distance(&self.lines, point, f64::INFINITY, |line| distance_from(line, point)))
    }
}

fn strokes(tips: impl Iterator<Item = (usize, Point2)>) -> Vec<Vec<Point2>> {
    let mut strokes: Vec<Vec<Point2>> = Vec::new();
    let mut before: Option<(usize, Point2)> = None;
    for (tick, tip) in tips {
        match strokes.last_mut() {
            Some(stroke) if before.is_some_and(|before| is_joined(before, (tick, tip))) => stroke.push(tip),
            _ => strokes.push(vec![tip]),
        }
        before = Some((tick, tip));
    }
    strokes
}

/// True if a tip of a whisker is joined to the next one. Each has the index of its tick.
pub(super) fn is_joined((last_tick, last_tip): (usize, Point2), (tick, tip): (usize, Point2)) -> bool {
    tick - last_tick <= MAX_BREAK && (tip - last_tip).norm() <= MAX_STEP
}

/// The distance (m) of a point from a line segment, which may have the length 0.
pub(super) fn distance_from(line: &Line<[f64; 2]>, point: Point2) -> f64 {
    (point - Point2::from(line.nearest_point(&point.into()))).norm()
}

/// The line segments of a stroke. A single tip is a segment of length 0.
fn lines(stroke: &[Point2]) -> impl Iterator<Item = (Point2, Point2)> {
    let single = if let [tip] = stroke { Some((*tip, *tip)) } else { None };
    stroke.windows(2).map(|ends| (ends[0], ends[1])).chain(single)
}
