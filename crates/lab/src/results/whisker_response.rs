//! The responses of whiskers in the result of a run.

use serde::{Deserialize, Serialize};

use crate::run::Trace;
use crate::score::Response;

/// How perception follows the bends of a whisker.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct WhiskerResponse {
    /// Name of the whisker.
    pub whisker: String,
    /// Time for which the simulated whisker was bent by more than 0.1 rad.
    pub bent_s: f64,
    /// Slope of the perceived bend over the true one: 1 for a perfect sensor. `None` if the whisker was bent for less
    /// than half a second.
    pub response: Option<f64>,
    /// True if the response is below 0.5: the whisker seems dead or insensitive.
    pub seems_dead: bool,
}

impl WhiskerResponse {
    /// `None` if the trace does not have the whisker.
    pub(super) fn new(response: &Response, trace: &Trace) -> Option<Self> {
        Some(Self {
            whisker: trace.whiskers.get(response.whisker)?.clone(),
            bent_s: response.bent_time,
            response: response.slope,
            seems_dead: response.is_dead(),
        })
    }
}
