//! The stop condition of a run.

use crate::geometry::{Point2, TunnelAxis};

/// The stop condition of a run.
///
/// With [`loop_closed`](Self::loop_closed), [`reached`](Self::reached), [`passed`](Self::passed) or [`mapped`](Self::mapped), a run
/// completes as soon as one of them holds. A policy can complete it by a success, too. With one of them or with [`succeeded`](Self::succeeded), a
/// run times out at [`time`](Self::time). Otherwise it completes at that time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stop {
    /// The time limit (simulated s).
    pub time: f64,
    /// The condition of a closed loop, if there is one.
    pub loop_closed: Option<LoopClosed>,
    /// The condition of a reached position, if there is one.
    pub reached: Option<Reached>,
    /// The share of a tunnel's axis (0 to 1) along which the platform's centre of mass has to remain between the walls, if
    /// there is such a condition.
    pub passed: Option<f64>,
    /// True if the map of the policy has to be complete.
    pub mapped: bool,
    /// True if the policy has to succeed.
    pub succeeded: bool,
    /// The condition for ending a run without progress; `None` to disable it.
    pub stalled: Option<Stalled>,
}

impl Stop {
    /// The end at a time (simulated s), without further conditions.
    #[must_use]
    pub fn at(time: f64) -> Self {
        Self { time, loop_closed: None, reached: None, passed: None, mapped: false, succeeded: false, stalled: None }
    }
}

/// The stop condition of a run, with the tunnels to which it refers.
#[derive(Debug, Clone, Copy)]
pub struct Goal<'s> {
    /// The condition.
    pub stop: &'s Stop,
    /// The axes of the tunnels.
    pub tunnels: &'s [TunnelAxis],
}

/// The newest tip of a whisker is near its first valid tip, after the platform has moved around that point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LoopClosed {
    /// The largest distance between both tips (m).
    pub within: f64,
    /// The shortest time between both tips (simulated s).
    pub after: f64,
}

/// The platform's centre of mass has reached a position.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reached {
    /// The position (m, world frame).
    pub place: Point2,
    /// The largest distance from the position (m).
    pub within: f64,
    /// The earliest time (simulated s).
    pub after: f64,
}

/// A run makes no progress: neither the platform's centre of mass nor a recorded tip reaches a new position. Repeated
/// circles are no progress, neither without contact nor along the traced contour.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stalled {
    /// A position is new if it is farther than this (m) from all previous ones.
    pub within: f64,
    /// The duration without progress (simulated s).
    pub after: f64,
}

impl Default for Stalled {
    fn default() -> Self {
        Self { within: 0.02, after: 60.0 }
    }
}
