//! Recorded tips, and how far they are from what is there.

use crate::geometry::{ContourSet, Point2, perpendicular};
use crate::run::Trace;
use vibrissa_runtime::rig::Rig;
use vibrissa_runtime::signal::MAX_WHISKERS;

/// A tip estimate that a policy recorded.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tip {
    /// Index of its tick in the trace.
    pub tick: usize,
    /// Index of its whisker in the trace.
    pub whisker: usize,
    /// Where it is estimated to be (m, world frame).
    pub tip_world: Point2,
    /// Its distance from the nearest surface (m), never negative: the thesis's absolute error (section 5.1).
    pub error: f64,
    /// How far off it may be by what the estimate tells (m), as a standard deviation.
    pub spread: f64,
    /// Its offset from the true tip; `None` if the world did not tell where that was.
    pub offset: Option<TipOffset>,
}

/// How far a tip estimate is from the point of the true tip that is nearest to the outline (m). Neither is negative.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TipOffset {
    /// Along the tangent of the outline where that is nearest to the true tip.
    pub along: f64,
    /// Across it, along the normal.
    pub across: f64,
}

/// An outlier's error exceeds this (m), which no use of a contour notices, plus [`OUTLIER_DEVIATIONS`].
pub const OUTLIER_ERROR: f64 = 1e-4;

/// How many of its own standard deviations an outlier's error exceeds besides [`OUTLIER_ERROR`]. A normal distribution does so once
/// in 16 000 cases.
pub const OUTLIER_DEVIATIONS: f64 = 4.0;

impl Tip {
    /// Whether the error is more than the estimate's own standard deviation (m) explains.
    #[must_use]
    pub fn is_outlier(&self) -> bool {
        let is_explained = self.error <= OUTLIER_ERROR + OUTLIER_DEVIATIONS * self.spread;
        // An error that is not a number is an outlier, and so is a standard deviation that is not.
        !is_explained
    }
}

/// Every valid tip estimate of a run on `rig`, whisker by whisker and in the order of time, against the exact `surfaces`.
#[must_use]
pub fn tips(trace: &Trace, surfaces: &ContourSet, rig: &Rig) -> Vec<Tip> {
    let whisker = |name: &String| rig.whiskers.iter().find(|whisker| whisker.name == *name);
    let radii: Vec<_> =
        trace.whiskers.iter().map(|name| whisker(name).map_or(0.0, |whisker| whisker.shaft.radius_at(1.0))).collect();
    whiskers(trace)
        .flat_map(|whisker| valid_tips(trace, whisker).map(move |(tick, tip_world)| (tick, whisker, tip_world)))
        .map(|(tick, whisker, tip_world)| {
            let record = &trace.ticks[tick];
            let (error, spread) = (surfaces.distance(tip_world), record.tip_spreads[whisker]);
            let offset = record.tip_ends[whisker].and_then(|end| offset(tip_world, end, radii[whisker], surfaces));
            Tip { tick, whisker, tip_world, error, spread, offset }
        })
        .collect()
}

/// The offset of an estimate (m, world frame) from a tip of this `radius` (m) whose axis ends at `end`; `None` if that is on the
/// outline itself, where its normal is unknown.
fn offset(tip_world: Point2, end: Point2, radius: f64, surfaces: &ContourSet) -> Option<TipOffset> {
    let outwards = (end - surfaces.nearest(end).point).try_normalize(0.0)?;
    let error = tip_world - (end - radius * outwards);
    let (along, across) = (error.dot(&perpendicular(outwards)).abs(), error.dot(&outwards).abs());
    (along.is_finite() && across.is_finite()).then_some(TipOffset { along, across })
}

/// Indices of the whiskers that the trace has room for.
pub(super) fn whiskers(trace: &Trace) -> std::ops::Range<usize> {
    0..trace.whiskers.len().min(MAX_WHISKERS)
}

/// The recorded tips of one whisker whose coordinates are finite, with the ticks' indices.
pub(super) fn valid_tips(trace: &Trace, whisker: usize) -> impl Iterator<Item = (usize, Point2)> {
    trace.tips(whisker).filter(|(_, tip)| is_finite(tip))
}

/// Whether a tip counts.
pub(super) fn is_finite(tip: &Point2) -> bool {
    tip.x.is_finite() && tip.y.is_finite()
}
