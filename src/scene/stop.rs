//! When a run ends.

/// When a run ends.
///
/// With [`loop_closed`](Self::loop_closed) a run is completed once its tips have come round, and times out at
/// [`time`](Self::time). Without, it is completed at that time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stop {
    /// The longest that a run takes (simulated s).
    pub time: f64,
    /// The condition of having gone all the way round, if that is the aim.
    pub loop_closed: Option<LoopClosed>,
}

/// The newest tip estimate of a whisker has come back to the first valid one of the same whisker.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LoopClosed {
    /// The two are at most this far apart (m).
    pub within: f64,
    /// The newest is at least this much later than the first (simulated s).
    pub after: f64,
}
