//! When the platform's body touched something.

use crate::run::Trace;

use super::estimate::LONGEST_BREAK;

/// The contacts of the platform's body, which no policy feels.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Collisions {
    /// How many separate ones there were. One goes on as long as the body is in touch again within [`LONGEST_BREAK`] ticks:
    /// a body that slides along a wall bounces off it.
    pub count: usize,
    /// Time in touch (s), to a tick.
    pub time: f64,
}

impl Collisions {
    /// The contacts of a run. A crash that ended it is one, or the end of one.
    #[must_use]
    pub fn of(trace: &Trace) -> Self {
        let ticks = trace.ticks.iter().map(|tick| tick.body_touches).chain(trace.crashed.then_some(true));
        let (mut collisions, mut touches, mut last) = (Self::default(), 0.0, None::<usize>);
        for (index, _) in ticks.enumerate().filter(|&(_, touches)| touches) {
            collisions.count += usize::from(last.is_none_or(|last| index - last > LONGEST_BREAK));
            touches += 1.0;
            last = Some(index);
        }
        Self { time: touches * trace.period, ..collisions }
    }
}
