//! Recorded tips and their errors.

use crate::run::Trace;
use vibrissa_runtime::rig::Rig;
use vibrissa_runtime::signal::MAX_WHISKERS;
use vibrissa_world::geometry::{ContourSet, Point2, perpendicular};

/// A tip estimate that a policy recorded.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tip {
    /// Index of its tick in the trace.
    pub tick: usize,
    /// Index of its whisker in the trace.
    pub whisker: usize,
    /// The estimated position (m, world frame).
    pub tip_world: Point2,
    /// The distance from the nearest surface (m), never negative: the baseline's absolute error (section 5.1).
    pub error: f64,
    /// The reported standard deviation (m).
    pub standard_deviation: f64,
    /// The offset from the true tip. `None` if the simulator did not report the true tip.
    pub offset: Option<TipOffset>,
}

/// The position (m) of a tip estimate relative to the point of the true tip that is nearest to the outline.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TipOffset {
    /// Along the tangent of the outline at its point nearest to the true tip.
    pub along: f64,
    /// Along the outward normal at that point.
    pub across: f64,
}

/// The absolute term (m) in the error threshold of an outlier. The other term is [`OUTLIER_DEVIATIONS`].
pub const OUTLIER_ERROR: f64 = 1e-4;

/// The number of reported standard deviations in the error threshold of an outlier, besides [`OUTLIER_ERROR`]. A normal
/// distribution exceeds it once in 16 000 cases.
pub const OUTLIER_DEVIATIONS: f64 = 4.0;

impl Tip {
    /// True if the error exceeds the threshold of an outlier.
    #[must_use]
    pub fn is_outlier(&self) -> bool {
        let is_explained = self.error <= OUTLIER_ERROR + OUTLIER_DEVIATIONS * self.standard_deviation;
        // An error or a standard deviation that is not a number makes an outlier.
        !is_explained
    }
}

/// All valid tip estimates of a run on `rig`, by whisker and time, with their errors against the exact `surfaces`.
#[must_use]
pub fn tips(trace: &Trace, surfaces: &ContourSet, rig: &Rig) -> Vec<Tip> {
    let whisker = |name: &String| rig.whiskers.iter().find(|whisker| whisker.name == *name);
    let radii: Vec<_> =
        trace.whiskers.iter().map(|name| whisker(name).map_or(0.0, |whisker| whisker.shaft.radius_at(1.0))).collect();
    whiskers(trace)
        .flat_map(|whisker| valid_tips(trace, whisker).map(move |(tick, tip_world)| (tick, whisker, tip_world)))
        .map(|(tick, whisker, tip_world)| {
            let record = &trace.ticks[tick];
            let (error, standard_deviation) = (surfaces.distance(tip_world), record.whiskers[whisker].tip_deviation);
            let offset =
                record.whiskers[whisker].tip_end.and_then(|end| offset(tip_world, end, radii[whisker], surfaces));
            Tip { tick, whisker, tip_world, error, standard_deviation, offset }
        })
        .collect()
}

/// The offset of an estimate (m, world frame) from a tip of this `radius` (m) whose axis ends at `end`. `None` if `end`
/// is on the outline, where the normal is undefined.
fn offset(tip_world: Point2, end: Point2, radius: f64, surfaces: &ContourSet) -> Option<TipOffset> {
    let outwards = (end - surfaces.nearest(end).point).try_normalize(0.0)?;
    let error = tip_world - (end - radius * outwards);
    let (along, across) = (error.dot(&perpendicular(outwards)), error.dot(&outwards));
    (along.is_finite() && across.is_finite()).then_some(TipOffset { along, across })
}

/// Indices of the whiskers in the trace.
pub(super) fn whiskers(trace: &Trace) -> std::ops::Range<usize> {
    0..trace.whiskers.len().min(MAX_WHISKERS)
}

/// The recorded tips of one whisker with finite coordinates, with the indices of their ticks.
pub(super) fn valid_tips(trace: &Trace, whisker: usize) -> impl Iterator<Item = (usize, Point2)> {
    trace.tips(whisker).filter(|(_, tip)| is_finite(tip))
}

/// True if a tip is valid.
pub(super) fn is_finite(tip: &Point2) -> bool {
    tip.x.is_finite() && tip.y.is_finite()
}
