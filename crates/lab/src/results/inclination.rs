//! The inclination of whiskers as part of JSON documents.

use std::collections::BTreeMap;

use serde::Serialize;

use super::run_result::state_name;
use crate::run::Trace;
use crate::score::InclinationFigures;

/// Inclination of whiskers that follow a surface.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Inclination {
    /// Largest angle between a shaft at its base and the surface: π/2 if they are perpendicular, less if the shaft is
    /// swept back.
    pub max_rad: f64,
    /// Smallest margin by which a round whisker stays in the plane. A real whisker with a negative margin slips out of the plane.
    pub margin_rad: f64,
    /// Name of the whisker with that angle.
    pub whisker: Option<String>,
    /// Time of that angle.
    pub time_s: f64,
    /// Estimated position of the tip at that time (world frame).
    pub tip_m: Option<[f64; 2]>,
    /// Name of the active state at that time.
    pub state: Option<String>,
    /// Time with a negative margin, added over all whiskers.
    pub beyond_s: f64,
    /// The states that are active in this time, with their parts of it.
    pub beyond_states: BTreeMap<String, f64>,
}

impl Inclination {
    pub(super) fn new(figures: &InclinationFigures, trace: &Trace) -> Self {
        let InclinationFigures { largest, margin, beyond, beyond_by_state } = figures;
        let part = |(&state, &time): (&Option<usize>, &f64)| Some((state_name(trace, state)?, time));
        Self {
            max_rad: largest.inclination,
            margin_rad: *margin,
            whisker: trace.whiskers.get(largest.whisker).cloned(),
            time_s: largest.time,
            tip_m: largest.tip_world.map(|tip| tip.coords.into()),
            state: state_name(trace, largest.state),
            beyond_s: *beyond,
            beyond_states: beyond_by_state.iter().filter_map(part).collect(),
        }
    }
}
