//! Contacts of the platform's body in the result of a run.

use serde::{Deserialize, Serialize};

use super::run_result::state_name;
use super::section::Section;
use crate::run::Trace;
use crate::score::Score;

/// Contacts of the platform's body.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Collisions {
    #[serde(flatten)]
    pub(super) figures: Section<6>,
    /// Time of the first contact.
    pub first_s: Option<f64>,
    /// Name of the active state at the first contact.
    pub first_state: Option<String>,
    /// Position of the platform's centre of mass at the first contact.
    pub first_position_m: Option<[f64; 2]>,
}

impl Collisions {
    pub(super) fn none() -> Self {
        Self { figures: Section::empty(), first_s: None, first_state: None, first_position_m: None }
    }

    pub(super) fn new(score: &Score, trace: &Trace) -> Self {
        let first = score.collisions.first;
        Self {
            figures: Section::of(score),
            first_s: first.map(|contact| contact.time),
            first_state: first.and_then(|contact| state_name(trace, contact.state)),
            first_position_m: first.map(|contact| contact.position.coords.into()),
        }
    }
}
