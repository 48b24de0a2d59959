//! The inclination of whiskers as part of JSON documents.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::run_result::state_name;
use super::section::Section;
use crate::run::Trace;
use crate::score::{InclinationFigures, Score};

/// Inclination of whiskers that follow a surface.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Inclination {
    #[serde(flatten)]
    pub(super) angles: Section<8>,
    /// Name of the whisker with that angle.
    pub whisker: Option<String>,
    /// Time of that angle.
    pub time_s: f64,
    /// Estimated position of the tip at that time (world frame).
    pub tip_m: Option<[f64; 2]>,
    /// Name of the active state at that time.
    pub state: Option<String>,
    #[serde(flatten)]
    pub(super) beyond: Section<9>,
    /// The states that are active in this time, with their parts of it.
    pub beyond_states: BTreeMap<String, f64>,
}

impl Inclination {
    pub(super) fn new(score: &Score, figures: &InclinationFigures, trace: &Trace) -> Self {
        let InclinationFigures { largest, beyond_by_state, .. } = figures;
        let part = |(&state, &time): (&Option<usize>, &f64)| Some((state_name(trace, state)?, time));
        Self {
            angles: Section::of(score),
            whisker: trace.whiskers.get(largest.whisker).cloned(),
            time_s: largest.time,
            tip_m: largest.tip_world.map(|tip| tip.coords.into()),
            state: state_name(trace, largest.state),
            beyond: Section::of(score),
            beyond_states: beyond_by_state.iter().filter_map(part).collect(),
        }
    }
}
