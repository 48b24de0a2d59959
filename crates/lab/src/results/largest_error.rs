//! The tip estimate with the largest error in the result of a run.

use serde::{Deserialize, Serialize};

use super::run_result::state_name;
use crate::run::Trace;
use crate::score::Tip;

/// The tip estimate with the largest error of a run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct LargestError {
    /// Its distance from the nearest surface.
    pub error_mm: f64,
    /// Its position in the world frame.
    pub tip_m: [f64; 2],
    /// Its time.
    pub time_s: f64,
    /// Name of the active state. `None` after a failure of the policy.
    pub state: Option<String>,
    /// Name of its whisker.
    pub whisker: String,
}

impl LargestError {
    /// `None` if the tick or the whisker of `tip` is not in the trace.
    pub(super) fn new(tip: &Tip, trace: &Trace) -> Option<Self> {
        let tick = trace.ticks.get(tip.tick)?;
        Some(Self {
            error_mm: 1e3 * tip.error,
            tip_m: tip.tip_world.coords.into(),
            time_s: tick.time,
            state: state_name(trace, tick.state),
            whisker: trace.whiskers.get(tip.whisker)?.clone(),
        })
    }
}
