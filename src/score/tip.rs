//! Recorded tips, and how far they are from what is there.

use crate::geometry::{ContourSet, Point2};
use crate::run::Trace;
use crate::signal::MAX_WHISKERS;

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
}

/// Every valid tip estimate of a run, whisker by whisker and in the order of time, against the exact `surfaces`.
#[must_use]
pub fn tips(trace: &Trace, surfaces: &ContourSet) -> Vec<Tip> {
    whiskers(trace)
        .flat_map(|whisker| valid_tips(trace, whisker).map(move |(tick, tip_world)| (tick, whisker, tip_world)))
        .map(|(tick, whisker, tip_world)| {
            let (error, spread) = (surfaces.distance(tip_world), trace.ticks[tick].tip_spreads[whisker]);
            Tip { tick, whisker, tip_world, error, spread }
        })
        .collect()
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
