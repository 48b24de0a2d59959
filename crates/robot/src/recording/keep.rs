//! Kept recordings: the part of a run that a regression test needs.

use std::io::{Read, Write};

use super::channel::Channel;
use super::error::{KeepError, ReadError};
use super::part_writer::{CHUNK, PartWriter};
use super::recording::Recording;
use super::tick_message::EventMessage;
use crate::fault::{FaultChange, FaultEvent};

/// Entry of the metadata with the time (ns) until which a recording was kept.
const KEPT_UNTIL: &str = "kept_until_ns";

/// Time (ns) by which an event may be recorded after a later step: the queue of records holds some seconds.
const EVENT_DELAY_NS: u64 = 10_000_000_000;

/// The size of a kept recording.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Kept {
    /// Number of steps.
    pub steps: u64,
    /// Start of the last step since the start of the program (ns).
    pub end_ns: u64,
}

/// The time (ns) of the first stop by a fault, if there is one.
///
/// # Errors
/// [`ReadError`] if the recording cannot be read.
pub fn first_stop<R: Read>(mut recording: Recording<R>) -> Result<Option<u64>, ReadError> {
    while let Some(message) = recording.next_message()? {
        if message.channel == Channel::Events
            && let event = FaultEvent::from(serde_json::from_slice::<EventMessage>(&message.data)?)
            && event.change == FaultChange::Reacted
        {
            return Ok(Some(event.time_ns));
        }
    }
    Ok(None)
}

/// Writes the steps, ticks and events until `until_ns` into one file, from the start of the run. Perception and machine
/// remember the whole run, so a replay needs all of it.
///
/// # Errors
/// [`KeepError`] if the recording cannot be read until then, or the output cannot be written.
pub fn keep<R: Read, W: Write>(mut recording: Recording<R>, until_ns: u64, output: W) -> Result<(W, Kept), KeepError> {
    let mut identity = recording.identity().clone();
    identity.insert(KEPT_UNTIL.to_owned(), until_ns.to_string());
    let mut part = PartWriter::new(output, recording.setup(), identity, CHUNK)?;
    let mut kept = Kept::default();
    let mut is_complete = false;
    loop {
        let message = match recording.next_message() {
            Ok(Some(message)) => message,
            Ok(None) => break,
            // Later messages are not needed.
            Err(_) if is_complete => break,
            Err(error) => return Err(error.into()),
        };
        if message.channel == Channel::Steps {
            is_complete |= message.time_ns > until_ns;
            if message.time_ns > until_ns.saturating_add(EVENT_DELAY_NS) {
                break;
            }
        }
        if message.time_ns <= until_ns && message.channel != Channel::Packets {
            if message.channel == Channel::Steps {
                kept = Kept { steps: kept.steps + 1, end_ns: message.time_ns };
            }
            part.write(&message)?;
        }
    }
    Ok((part.finish()?, kept))
}
