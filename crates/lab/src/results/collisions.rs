//! Contacts of the platform's body in the result of a run.

use serde::Serialize;

use super::run_result::state_name;
use crate::run::Trace;
use crate::score;

/// Contacts of the platform's body.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Collisions {
    /// Number of separate contacts.
    pub count: usize,
    /// Time in contact.
    pub time_s: f64,
    /// Time of the first contact.
    pub first_s: Option<f64>,
    /// Name of the active state at the first contact.
    pub first_state: Option<String>,
    /// Position of the platform's centre of mass at the first contact.
    pub first_position_m: Option<[f64; 2]>,
}

impl Collisions {
    pub(super) fn new(figures: &score::Collisions, trace: &Trace) -> Self {
        let first = figures.first;
        Self {
            count: figures.count,
            time_s: figures.time,
            first_s: first.map(|contact| contact.time),
            first_state: first.and_then(|contact| state_name(trace, contact.state)),
            first_position_m: first.map(|contact| contact.position.coords.into()),
        }
    }
}
