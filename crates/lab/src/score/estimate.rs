//! The estimated contour of a run.

use std::cell::Cell;
use std::ops::Range;

use rstar::RTree;
use rstar::primitives::{GeomWithData, Line};

use super::lipschitz::Foot;
use super::statistics::Statistics;
use super::tip::{valid_tips, whiskers};
use crate::run::Trace;
use vibrissa_world::geometry::{Point2, TreePoint, min_distance, min_distance_down_to, plane_point, tree_point};

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
    /// All lines of the strokes, in their order.
    lines: Vec<StrokeLine>,
    /// The lines with their indices.
    tree: RTree<GeomWithData<Line<TreePoint>, usize>>,
}

/// A line of a stroke.
#[derive(Debug, Clone, Copy)]
struct StrokeLine {
    line: Line<TreePoint>,
    stroke: usize,
    /// The length of the stroke (m) before it.
    start: f64,
}

impl StrokeLine {
    fn foot(&self, point: Point2) -> Foot {
        let place = plane_point(self.line.nearest_point(&tree_point(point)));
        let arc_length = self.start + (place - plane_point(self.line.from)).norm();
        Foot { distance: (point - place).norm(), place, curve: self.stroke, arc_length, loop_length: None }
    }

    fn end(&self) -> f64 {
        self.start + (plane_point(self.line.to) - plane_point(self.line.from)).norm()
    }
}

impl Estimate {
    /// The estimated contour of a run.
    #[must_use]
    pub fn new(trace: &Trace) -> Self {
        Self::of(whiskers(trace).map(|whisker| valid_tips(trace, whisker)))
    }

    /// The estimated contour of the tips of each whisker (m, world frame). They are finite, in order, and have the indices
    /// of their ticks.
    #[must_use]
    pub fn of<T: Iterator<Item = (usize, Point2)>>(tips: impl Iterator<Item = T>) -> Self {
        let strokes: Vec<_> = tips.flat_map(strokes).collect();
        let mut all: Vec<StrokeLine> = Vec::new();
        for (stroke, points) in strokes.iter().enumerate() {
            for (from, to) in lines(points) {
                let before = all.last().filter(|before| before.stroke == stroke);
                let start = before.map_or(0.0, StrokeLine::end);
                all.push(StrokeLine { line: Line::new(tree_point(from), tree_point(to)), stroke, start });
            }
        }
        let leaves = all.iter().enumerate().map(|(index, of)| GeomWithData::new(of.line, index));
        Self { tree: RTree::bulk_load(leaves.collect()), strokes, lines: all }
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
        (!self.lines.is_empty())
            .then(|| min_distance(&self.tree, point, f64::INFINITY, |leaf| distance_from(leaf.geom(), point)))
    }

    /// True if a point is at most `distance` (m) away from a stroke. It takes the less time, the farther away the point is.
    #[must_use]
    pub fn is_within(&self, distance: f64, point: Point2) -> bool {
        self.distance_between(distance..distance.next_up(), point) <= distance
    }

    /// The distance (m) of a point from the nearest stroke if it is in a `range`. Otherwise any number at or beyond the same end
    /// of the range.
    pub(super) fn distance_between(&self, range: Range<f64>, point: Point2) -> f64 {
        let Range { start: enough, end: within } = range;
        min_distance_down_to(enough, &self.tree, point, within, |leaf| distance_from(leaf.geom(), point))
    }

    /// The foot of a point on the strokes. Their indices are those of the curves.
    pub(super) fn foot(&self, point: Point2) -> Foot {
        let nearest = Cell::new((f64::INFINITY, None));
        min_distance(&self.tree, point, f64::INFINITY, |leaf| {
            let distance = distance_from(leaf.geom(), point);
            if distance < nearest.get().0 {
                nearest.set((distance, Some(leaf.data)));
            }
            distance
        });
        let line = nearest.get().1.and_then(|index| self.lines.get(index));
        line.map_or_else(Foot::nowhere, |line| line.foot(point))
    }

    /// The nearest foot of a point on the stroke of another foot, within a distance `reach` (m) along the stroke. `None` if the
    /// other foot is not on a stroke.
    pub(super) fn foot_along(&self, other: &Foot, point: Point2, reach: f64) -> Option<Foot> {
        let (first, last) = (other.arc_length - reach, other.arc_length + reach);
        let from = self.lines.partition_point(|line| (line.stroke, line.end()) < (other.curve, first));
        let lines = self.lines.get(from..)?.iter();
        let near = lines.take_while(|line| line.stroke == other.curve && line.start <= last);
        near.map(|line| line.foot(point)).min_by(|a, b| a.distance.total_cmp(&b.distance))
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
pub(super) fn distance_from(line: &Line<TreePoint>, point: Point2) -> f64 {
    (point - plane_point(line.nearest_point(&tree_point(point)))).norm()
}

/// The line segments of a stroke. A single tip is a segment of length 0.
fn lines(stroke: &[Point2]) -> impl Iterator<Item = (Point2, Point2)> {
    let single = if let [tip] = stroke { Some((*tip, *tip)) } else { None };
    stroke.windows(2).map(|ends| (ends[0], ends[1])).chain(single)
}
