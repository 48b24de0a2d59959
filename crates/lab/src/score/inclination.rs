//! The inclination of whiskers.

use std::collections::BTreeMap;

use crate::run::{Trace, WhiskerRecord};
use vibrissa_runtime::mechanics::out_of_plane_margin;
use vibrissa_world::geometry::Point2;

/// The inclination of the whiskers that followed a surface, as perceived.
#[derive(Debug, Clone, PartialEq)]
pub struct InclinationFigures {
    /// The largest inclination. Its margin is the least one.
    pub largest: Inclined,
    /// The margin (rad) by which a round whisker with that inclination [stays in the plane](out_of_plane_margin).
    pub margin: f64,
    /// The time (s) with a negative margin, added over all whiskers, with the resolution of a tick.
    pub beyond: f64,
    /// The parts of this time by the index of the active state. `None` is after a failure.
    pub beyond_by_state: BTreeMap<Option<usize>, f64>,
}

/// A whisker with an inclination, in a tick.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Inclined {
    /// The inclination (rad).
    pub inclination: f64,
    /// The index of the whisker in the trace.
    pub whisker: usize,
    /// The time (s).
    pub time: f64,
    /// Estimated position of the tip (m, world frame).
    pub tip_world: Option<Point2>,
    /// The index of the active state. `None` after a failure.
    pub state: Option<usize>,
}

impl InclinationFigures {
    /// The figures of a run with this assumed coefficient of friction. `None` if no whisker recorded a contour.
    #[must_use]
    pub fn of(trace: &Trace, friction: f64) -> Option<Self> {
        let largest = inclined(trace).max_by(|a, b| a.inclination.total_cmp(&b.inclination))?;
        let margin = |inclination| out_of_plane_margin(inclination, friction);
        let mut ticks: BTreeMap<Option<usize>, u32> = BTreeMap::new();
        for beyond in inclined(trace).filter(|one| margin(one.inclination) < 0.0) {
            *ticks.entry(beyond.state).or_default() += 1;
        }
        let time = |ticks: u32| f64::from(ticks) * trace.period;
        Some(Self {
            largest,
            margin: margin(largest.inclination),
            beyond: time(ticks.values().sum()),
            beyond_by_state: ticks.into_iter().map(|(state, ticks)| (state, time(ticks))).collect(),
        })
    }
}

/// All whiskers with an inclination, in the order of ticks.
fn inclined(trace: &Trace) -> impl Iterator<Item = Inclined> {
    trace.ticks.iter().flat_map(|tick| {
        tick.whiskers.iter().enumerate().filter_map(|(whisker, WhiskerRecord { contact, .. })| {
            let inclination = contact.inclination?;
            Some(Inclined { inclination, whisker, time: tick.time, tip_world: contact.tip_world, state: tick.state })
        })
    })
}
