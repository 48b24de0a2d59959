//! When a run ends.

use crate::geometry::Point2;

/// When a run ends.
///
/// With [`loop_closed`](Self::loop_closed) or [`reached`](Self::reached) a run is completed once either has come about, and
/// times out at [`time`](Self::time). Without, it is completed at that time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stop {
    /// The longest that a run takes (simulated s).
    pub time: f64,
    /// The condition of having gone all the way round, if that is the aim.
    pub loop_closed: Option<LoopClosed>,
    /// The condition of having come to a place, if that is the aim.
    pub reached: Option<Reached>,
    /// When a run is given up; `None` if never.
    pub stalled: Option<Stalled>,
}

/// The newest tip estimate of a whisker has come back to the first valid one of the same whisker, after the platform has gone
/// round that place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LoopClosed {
    /// The two are at most this far apart (m).
    pub within: f64,
    /// The newest is at least this much later than the first (simulated s).
    pub after: f64,
}

/// The platform's centre of mass has come to a place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reached {
    /// The place (m, world frame).
    pub place: Point2,
    /// The two are at most this far apart (m).
    pub within: f64,
    /// Not before this time (simulated s).
    pub after: f64,
}

/// A run makes no progress: neither the platform's centre of mass nor a recorded tip comes anywhere new. Going round in
/// circles is none, whether in the air or along what has been traced.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stalled {
    /// A place is new that is further than this (m) from all where the same has been.
    pub within: f64,
    /// For this long (simulated s).
    pub after: f64,
}

impl Default for Stalled {
    fn default() -> Self {
        Self { within: 0.02, after: 60.0 }
    }
}
