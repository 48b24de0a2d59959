//! `stop`: when a run ends.

use super::fault;
use super::fields::Fields;
use super::key::Key;
use super::node::Entry;
use super::reader::Reader;
use crate::diagnostic::Diagnostic;
use crate::scene::{LoopClosed, Stop};
use crate::units::{Dimension, format_si};

const TIME: Key = Key::new("time", Dimension::TIME, (1e-3, 86_400.0), "120 s");
const WITHIN: Key = Key::new("within", Dimension::LENGTH, (1e-6, 1.0), "5 mm");
const AFTER: Key = Key::new("after", Dimension::TIME, (0.0, 86_400.0), "5 s");

/// Reads `stop`.
pub(super) fn read(reader: &mut Reader<'_>, entry: &Entry) -> Option<Stop> {
    let mut fields = Fields::of(reader, &entry.value, "a stop", entry.key.span)?;
    let time = fields.number(reader, &TIME);
    let loop_closed = fields.entry("loop_closed");
    fields.finish(reader);
    let Some(entry) = loop_closed else {
        return Some(Stop { time: time?.value, loop_closed: None });
    };

    let mut fields = Fields::of(reader, &entry.value, "the closing of a loop", entry.key.span)?;
    let within = fields.number(reader, &WITHIN);
    let after = fields.number(reader, &AFTER);
    fields.finish(reader);
    let (time, within, after) = (time?, within?, after?);
    if after.value >= time.value {
        let label = format!("not before the end, at {}", format_si(time.value, Dimension::TIME));
        let fault = Diagnostic::error(fault::TIMING, "the loop can never close", after.span, label);
        reader.report(fault.note(time.span, "the run ends here").hint("make `after` shorter than `time`"));
        return None;
    }
    Some(Stop { time: time.value, loop_closed: Some(LoopClosed { within: within.value, after: after.value }) })
}
