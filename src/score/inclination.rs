//! The inclination of whiskers.

use crate::run::{TickRecord, Trace};
use vibrissa_runtime::mechanics::out_of_plane_margin;

/// The inclination of the whiskers that followed a surface, as perceived.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct InclinationFigures {
    /// The largest inclination (rad).
    pub largest: f64,
    /// The margin (rad) by which a round whisker with that inclination [stays in the plane](out_of_plane_margin).
    pub margin: f64,
    /// The index of the active state at the largest inclination. `None` after a failure.
    pub state: Option<usize>,
    /// The time (s) with a negative margin, added over all whiskers, with the resolution of a tick.
    pub beyond: f64,
}

impl InclinationFigures {
    /// The figures of a run with this assumed coefficient of friction. `None` if no whisker recorded a contour.
    #[must_use]
    pub fn of(trace: &Trace, friction: f64) -> Option<Self> {
        let inclinations = || {
            let of_tick = |tick: &TickRecord| tick.contacts.map(|contact| (contact.inclination, tick.state));
            trace.ticks.iter().flat_map(of_tick).filter_map(|(inclination, state)| Some((inclination?, state)))
        };
        let (largest, state) = inclinations().max_by(|(a, _), (b, _)| a.total_cmp(b))?;
        let margin = |inclination| out_of_plane_margin(inclination, friction);
        let beyond = inclinations().filter(|&(inclination, _)| margin(inclination) < 0.0).count();
        Some(Self { largest, margin: margin(largest), state, beyond: beyond as f64 * trace.period })
    }
}
