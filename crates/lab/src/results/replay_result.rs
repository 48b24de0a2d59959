//! The result of a replay as a JSON document.

use std::collections::BTreeMap;

use serde::Serialize;
use vibrissa_robot::recording::{Difference, Replayed};

use super::drive_result::fault_records;
use super::{Document, FaultRecord};

/// The replay of a recording.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct ReplayResult {
    /// The metadata of the recording, such as `machine`, `machine_sha256` and `program`.
    pub recording: BTreeMap<String, String>,
    /// Number of control steps.
    pub steps: u64,
    /// Number of control steps whose results were compared.
    pub ticks: u64,
    /// Time of the last step since the start of the recorded program.
    pub end_s: f64,
    /// True if the end of the recording is missing.
    pub is_cut: bool,
    /// The recorded faults. Their times are counted from the start of the recorded program.
    pub faults: Vec<FaultRecord>,
    /// The first difference. `None` if every result is bit-identical.
    pub difference: Option<DifferenceRecord>,
}

/// A result that differs.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct DifferenceRecord {
    /// Number of the step, from 0.
    pub step: u64,
    /// Time of the step since the start of the recorded program.
    pub time_s: f64,
    /// The field, such as `command.x`.
    pub field: String,
    /// The recorded value.
    pub recorded: String,
    /// The value of the replay.
    pub replayed: String,
}

impl Document for ReplayResult {
    const FORMAT: &'static str = "replay";
}

impl ReplayResult {
    /// The result of replaying the recording with these metadata.
    #[must_use]
    pub fn new(recording: BTreeMap<String, String>, replayed: &Replayed) -> Self {
        Self {
            recording,
            steps: replayed.steps,
            ticks: replayed.ticks,
            end_s: replayed.end_ns as f64 * 1e-9,
            is_cut: replayed.is_cut,
            faults: fault_records(&replayed.events, 0),
            difference: replayed.difference.as_ref().map(DifferenceRecord::from),
        }
    }
}

impl From<&Difference> for DifferenceRecord {
    fn from(difference: &Difference) -> Self {
        Self {
            step: difference.step,
            time_s: difference.time_ns as f64 * 1e-9,
            field: difference.field.clone(),
            recorded: difference.recorded.clone(),
            replayed: difference.replayed.clone(),
        }
    }
}
