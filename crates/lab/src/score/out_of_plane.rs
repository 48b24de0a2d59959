//! The motion of tips out of the plane.

use crate::run::Trace;

/// The motion of the tips of a run out of the plane.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct OutOfPlaneFigures {
    /// The largest distance of a tip from the plane (m).
    pub distance: f64,
    /// The number of slips. A slip begins when a tip comes above the top or below the bottom of the objects, and ends
    /// when it is back between them.
    pub slips: usize,
    /// The first slip.
    pub first: Option<Slip>,
}

/// A slip of a tip out of the plane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Slip {
    /// The time (s), with the resolution of a tick.
    pub time: f64,
    /// The index of the whisker.
    pub whisker: usize,
    /// The index of the active state. `None` after a failure.
    pub state: Option<usize>,
}

impl OutOfPlaneFigures {
    /// The figures of a run. `None` in a planar world.
    #[must_use]
    pub fn of(trace: &Trace) -> Option<Self> {
        let mut figures: Option<Self> = None;
        for whisker in 0..trace.whiskers.len() {
            let mut was_slipping = false;
            for tick in &trace.ticks {
                let Some(motion) = tick.whiskers[whisker].out_of_plane else { continue };
                let figures = figures.get_or_insert_default();
                figures.distance = figures.distance.max(motion.distance);
                if motion.slips && !was_slipping {
                    figures.slips += 1;
                    if figures.first.is_none_or(|first| tick.time < first.time) {
                        figures.first = Some(Slip { time: tick.time, whisker, state: tick.state });
                    }
                }
                was_slipping = motion.slips;
            }
        }
        figures
    }
}
