//! Coverage while a run goes on.

use std::ops::Range;

use rstar::primitives::Line;

use super::coverage::{COVERAGE_RESOLUTION, COVERAGE_TOLERANCE};
use super::estimate::{distance_from, is_joined};
use super::lipschitz::stretches_below;
use super::tip::is_finite;
use vibrissa_runtime::signal::MAX_WHISKERS;
use vibrissa_world::geometry::{ContourSet, Point2, tree_point};

/// The coverage of an estimate that grows tip by tip.
///
/// What is traced is the union of what each line of the estimate traces. So a tip adds the intervals of its own line, and costs
/// the same however many tips there are.
#[derive(Debug, Clone)]
pub struct CoverageTracker {
    reference: ContourSet,
    /// The last tip of each whisker, with the index of its tick.
    last: [Option<(usize, Point2)>; MAX_WHISKERS],
    /// The traced intervals of each contour of the reference, disjoint and ascending (m).
    traced: Vec<Vec<Range<f64>>>,
}

impl CoverageTracker {
    /// The coverage of a reference before the first tip.
    #[must_use]
    pub fn new(reference: ContourSet) -> Self {
        let traced = reference.contours().map(|_| Vec::new()).collect();
        Self { reference, last: [None; MAX_WHISKERS], traced }
    }

    /// Adds the tip (m, world frame) that a whisker of the trace recorded in the tick with this index. The tips of a whisker come in
    /// the order of time. One that is not finite is ignored.
    pub fn add(&mut self, whisker: usize, tick: usize, tip: Point2) {
        let Some(last) = self.last.get_mut(whisker).filter(|_| is_finite(&tip)) else { return };
        let before = last.replace((tick, tip)).filter(|&before| is_joined(before, (tick, tip)));
        let line = Line::new(tree_point(before.map_or(tip, |(_, tip)| tip)), tree_point(tip));
        for (contour, traced) in self.reference.contours().zip(&mut self.traced) {
            let distance = |s, _: Range<f64>| distance_from(&line, contour.point_at(s));
            for new in stretches_below(contour.length(), COVERAGE_TOLERANCE, COVERAGE_RESOLUTION, distance) {
                unite(traced, new);
            }
        }
    }

    /// The traced share of the reference's length (0 to 1): the [coverage](super::coverage) of all tips until now. Each of both has the
    /// error that `coverage` states.
    #[must_use]
    pub fn coverage(&self) -> f64 {
        // An empty `sum` is negative zero.
        let length = self.traced.iter().flatten().fold(0.0, |sum, stretch| sum + stretch.end - stretch.start);
        (length / self.reference.length()).min(1.0)
    }
}

/// Adds an interval to disjoint ascending ones.
fn unite(intervals: &mut Vec<Range<f64>>, new: Range<f64>) {
    let first = intervals.partition_point(|own| own.end < new.start);
    let after = intervals.partition_point(|own| own.start <= new.end);
    let joined = intervals.get(first..after).unwrap_or_default();
    let start = joined.first().map_or(new.start, |own| own.start.min(new.start));
    let end = joined.last().map_or(new.end, |own| own.end.max(new.end));
    intervals.splice(first..after, [start..end]);
}
