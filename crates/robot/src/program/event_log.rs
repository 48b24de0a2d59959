//! The log of faults on standard error.

use super::command_line::print_error;
use crate::drive::{LoopRecord, RecordSink};
use crate::fault::{FaultChange, FaultEvent};

/// Prints every change of a fault.
#[derive(Debug)]
pub(super) struct EventLog;

impl RecordSink for EventLog {
    fn take(&mut self, record: &LoopRecord) {
        if let LoopRecord::Event(event) = record {
            print_error(&line(event));
        }
    }
}

fn line(event: &FaultEvent) -> String {
    let change = match event.change {
        FaultChange::Detected => "detected",
        FaultChange::Reacted => "the robot is stopped",
        FaultChange::Recovered => "over",
    };
    format!("{:.3} s: {}: {}: {change}", event.time_ns as f64 * 1e-9, event.fault.kind.name(), event.fault)
}
