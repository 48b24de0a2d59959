//! The log of faults, of violated contracts and of the policy's messages on standard error.

use std::sync::Arc;

use vibrissa_runtime::machine::{LoggedMessage, Program};

use super::command_line::print_error;
use crate::drive::{LoopRecord, RecordSink, TimedMessage, Violation};
use crate::fault::{FaultChange, FaultEvent};

/// Prints every change of a fault, every violation of a contract when it begins, and every message of the policy.
#[derive(Debug)]
pub(super) struct EventLog {
    /// `None` in the sensor IO.
    program: Option<Arc<Program>>,
}

impl EventLog {
    /// The log of a program that runs this policy.
    pub(super) fn new(program: Option<Arc<Program>>) -> Self {
        Self { program }
    }
}

impl RecordSink for EventLog {
    fn take(&mut self, record: &LoopRecord) {
        match (record, &self.program) {
            (LoopRecord::Event(event), _) => print_error(&fault(event)),
            (LoopRecord::Violation(begun), Some(program)) => print_error(&violation(program, begun)),
            (LoopRecord::Message(logged), Some(program)) => print_error(&message(program, logged)),
            _ => {}
        }
    }
}

fn fault(event: &FaultEvent) -> String {
    let change = match event.change {
        FaultChange::Detected => "detected",
        FaultChange::Reacted => "the robot is stopped",
        FaultChange::Recovered => "over",
    };
    format!("{:.3} s: {}: {}: {change}", seconds(event.time_ns), event.fault.kind.name(), event.fault)
}

fn violation(program: &Program, begun: &Violation) -> String {
    let (state, text) = match program.contract(begun.contract) {
        Some((Some(state), contract)) => (format!("state {}: ", state.name), &*contract.text),
        Some((None, contract)) => (String::new(), &*contract.text),
        None => (String::new(), "an unknown contract"),
    };
    format!("{:.3} s: {state}the policy violates `{text}`", seconds(begun.time_ns))
}

fn message(program: &Program, logged: &TimedMessage) -> String {
    let LoggedMessage { message, numbers } = &logged.message;
    let time = seconds(logged.time_ns);
    let Some(message) = program.outputs.messages.get(*message) else {
        return format!("{time:.3} s: an unknown message");
    };
    let state = message.state.and_then(|state| program.states.get(state));
    let state = state.map_or_else(String::new, |state| format!("state {}: ", state.name));
    format!("{time:.3} s: {state}{}", message.shown(numbers, &program.whiskers))
}

fn seconds(time_ns: u64) -> f64 {
    time_ns as f64 * 1e-9
}
