//! Collisions of the platform's body.

use crate::run::Trace;

use super::estimate::MAX_BREAK;

/// The contacts of the platform's body. Policies cannot observe them.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Collisions {
    /// The number of separate contacts. A contact continues if the body touches again within [`MAX_BREAK`] ticks,
    /// because a body that slides along a wall bounces.
    pub count: usize,
    /// The duration of all contacts (s), with the resolution of a tick.
    pub time: f64,
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
        Self { time: touches * trace.period, ..collisions }
    }
}
