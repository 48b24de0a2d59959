//! Collisions of the platform's body.

use crate::run::Trace;
use vibrissa_world::geometry::Point2;

use super::estimate::MAX_BREAK;

/// The contacts of the platform's body. Policies cannot observe them.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Collisions {
    /// The number of separate contacts. A contact continues if the body touches again within [`MAX_BREAK`] ticks,
    /// because a body that slides along a wall bounces.
    pub count: usize,
    /// The duration of all contacts (s), with the resolution of a tick.
    pub time: f64,
    /// The first contact.
    pub first: Option<FirstContact>,
}

/// The tick of the first contact of the platform's body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FirstContact {
    /// The time (s).
    pub time: f64,
    /// The position of the platform's centre of mass (m, world frame).
    pub position: Point2,
    /// The index of the active state. `None` after a failure.
    pub state: Option<usize>,
}

impl Collisions {
    /// The contacts of a run. A crash at its end counts as a contact, or as the end of one.
    #[must_use]
    pub fn of(trace: &Trace) -> Self {
        let ticks = trace.ticks.iter().map(|tick| tick.body_touches).chain(trace.crashed.then_some(true));
        let (mut collisions, mut touches, mut last) = (Self::default(), 0.0, None::<usize>);
        for (index, _) in ticks.enumerate().filter(|&(_, touches)| touches) {
            collisions.count += usize::from(last.is_none_or(|last| index - last > MAX_BREAK));
            touches += 1.0;
            last = Some(index);
        }
        // A crash ends the run after the last tick.
        let touching =
            trace.ticks.iter().find(|tick| tick.body_touches).or(trace.ticks.last().filter(|_| trace.crashed));
        let first =
            touching.map(|tick| FirstContact { time: tick.time, position: tick.body.position, state: tick.state });
        Self { time: touches * trace.period, first, ..collisions }
    }
}
