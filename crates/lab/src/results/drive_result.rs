//! The result of a run with the robot's loop as a JSON document.

use std::collections::BTreeMap;

use serde::Serialize;
use vibrissa_robot::emulation::Injection;
use vibrissa_robot::fault::{FaultChange, FaultEvent};
use vibrissa_robot::vitals::Phase;

use super::{Document, RunResult};

/// The result of a run with the robot's loop and emulated sensors.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct DriveResult {
    /// The run.
    pub run: RunResult,
    /// The faults, in the order of their detection. Their times are counted from the begin of the machine.
    pub faults: Vec<FaultRecord>,
    /// Missed periods of each phase of the loop.
    pub missed: BTreeMap<String, u64>,
    /// Injected faults that neither the supervisor nor the policy has noticed, because they had no effect or the run had ended.
    pub undetected: Vec<UndetectedFault>,
}

/// An injected fault that was not detected.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct UndetectedFault {
    /// Kind of the fault that the supervisor should have detected.
    pub kind: String,
    /// Index of the whisker or bus.
    pub part: u8,
    /// Time of the injection.
    pub at_s: f64,
}

/// A fault with its times.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct FaultRecord {
    /// Kind of the fault.
    pub kind: String,
    /// Index of the whisker or bus that has it.
    pub part: u8,
    /// Time of its detection.
    pub detected_s: f64,
    /// Time of the first stop command after it. `None` if the robot went on.
    pub reacted_s: Option<f64>,
    /// Time at which it was over. `None` if it lasted until the end.
    pub recovered_s: Option<f64>,
}

impl Document for DriveResult {
    const FORMAT: &'static str = "drive";
    // A run that met its stop condition but not all expectations was `completed`.
    const VERSION: u32 = 2;
}

impl DriveResult {
    /// The result of a run that began at `begun_ns` of the robot's time.
    #[must_use]
    pub fn new(
        run: RunResult,
        events: &[FaultEvent],
        begun_ns: u64,
        missed: [u64; Phase::ALL.len()],
        undetected: &[Injection],
    ) -> Self {
        let missed = Phase::ALL.iter().zip(missed).map(|(phase, count)| (phase.name().to_owned(), count));
        let undetected = undetected.iter().filter_map(|injection| {
            let kind = injection.kind.expected()?.name().to_owned();
            Some(UndetectedFault { kind, part: injection.part, at_s: injection.at_ms as f64 * 1e-3 })
        });
        let faults = fault_records(events, begun_ns);
        Self { run, faults, missed: missed.collect(), undetected: undetected.collect() }
    }
}

/// Joins the changes of each fault. Times are counted from `begun_ns`.
pub(super) fn fault_records(events: &[FaultEvent], begun_ns: u64) -> Vec<FaultRecord> {
    let seconds = |time_ns: u64| (time_ns as f64 - begun_ns as f64) * 1e-9;
    let mut records: Vec<FaultRecord> = Vec::new();
    for event in events {
        let (kind, part) = (event.fault.kind.name(), event.fault.part);
        let time = seconds(event.time_ns);
        let open = records.iter_mut().rev().find(|record| record.kind == kind && record.part == part);
        match (event.change, open) {
            (FaultChange::Detected, _) => records.push(FaultRecord {
                kind: kind.to_owned(),
                part,
                detected_s: time,
                reacted_s: None,
                recovered_s: None,
            }),
            (FaultChange::Reacted, Some(record)) => record.reacted_s = Some(time),
            (FaultChange::Recovered, Some(record)) => record.recovered_s = Some(time),
            (_, None) => {}
        }
    }
    records
}
