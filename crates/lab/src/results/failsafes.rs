//! The fallback transitions in the result of a run.

use serde::{Deserialize, Serialize};

use crate::run::Trace;

/// Fallback transitions.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Failsafes {
    /// Number of fallback transitions.
    pub count: usize,
    /// Time of the first one.
    pub first_s: Option<f64>,
    /// Name of the state that the first one left.
    pub first_state: Option<String>,
    /// Cause of the first one.
    pub first_cause: Option<String>,
}

impl Failsafes {
    pub(super) fn new(trace: &Trace) -> Self {
        let first = trace.fallbacks().next();
        Self {
            count: trace.fallbacks().count(),
            first_s: first.map(|(tick, _)| tick.time),
            first_state: first.and_then(|(_, fallback)| trace.states.get(fallback.left).cloned()),
            first_cause: first.map(|(_, fallback)| fallback.cause.to_string()),
        }
    }
}
