//! The traced part of an outline while a run goes on.

use vibrissa::geometry::{ContourSet, Point2};
use vibrissa::run::TickRecord;
use vibrissa::score::{COVERAGE_TOLERANCE, MAX_BREAK, MAX_STEP};
use vibrissa_runtime::signal::MAX_WHISKERS;

/// Distance of the points that stand for the outline (m). The traced length has an error of about this at each end of a
/// traced part.
const SPACING: f64 = 5e-4;

/// Points of the exact outlines, and which of them are traced. A point is traced if the estimated contour comes near it,
/// as for the coverage of a run.
pub(crate) struct TracedOutline {
    /// Points that are not traced yet, each with the length that it stands for (m).
    untraced: Vec<(Point2, f64)>,
    /// The last recorded tip of each whisker, with its tick.
    last: [Option<(usize, Point2)>; MAX_WHISKERS],
}

impl TracedOutline {
    pub(crate) fn new(outlines: &ContourSet) -> Self {
        let mut untraced = Vec::new();
        for contour in outlines.contours() {
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "an outline is some metres long"
            )]
            let count = (contour.length() / SPACING).ceil().max(1.0) as usize;
            let share = contour.length() / count as f64;
            untraced.extend((0..count).map(|index| (contour.point_at((index as f64 + 0.5) * share), share)));
        }
        Self { untraced, last: [None; MAX_WHISKERS] }
    }

    /// Adds the recorded tips of the tick with this index. Returns the length that they trace (m).
    pub(crate) fn add(&mut self, index: usize, tick: &TickRecord) -> f64 {
        let mut gained = 0.0;
        for (last, whisker) in self.last.iter_mut().zip(&tick.whiskers) {
            let Some(tip) = whisker.tip.filter(|tip| tip.x.is_finite() && tip.y.is_finite()) else { continue };
            let continues =
                |&(before, place): &(usize, Point2)| index - before <= MAX_BREAK && (tip - place).norm() <= MAX_STEP;
            let from = last.filter(continues).map_or(tip, |(_, place)| place);
            *last = Some((index, tip));
            self.untraced.retain(|&(point, length)| {
                let is_traced = distance(point, from, tip) <= COVERAGE_TOLERANCE;
                gained += if is_traced { length } else { 0.0 };
                !is_traced
            });
        }
        gained
    }
}

/// The distance of a point from a line segment.
fn distance(point: Point2, start: Point2, end: Point2) -> f64 {
    let along = end - start;
    let length = along.norm_squared();
    let share = if length > 0.0 { ((point - start).dot(&along) / length).clamp(0.0, 1.0) } else { 0.0 };
    (point - (start + share * along)).norm()
}
