//! `stop`: when a run ends.

use super::fault;
use super::fields::Fields;
use super::key::Key;
use super::node::{Entry, Placed};
use super::reader::Reader;
use crate::diagnostic::Diagnostic;
use crate::scene::{LoopClosed, Stop};
use crate::units::{Dimension, format_si};

const TIME: Key = Key::new("time", Dimension::TIME, (1e-3, 86_400.0), "120 s");
const WITHIN: Key = Key::new("within", Dimension::LENGTH, (1e-6, 1.0), "5 mm");
const AFTER: Key = Key::new("after", Dimension::TIME, (0.0, 86_400.0), "5 s");

/// The most control ticks of a run: the trace keeps every one of them. Ninety hours at 30 Hz.
const MOST_TICKS: f64 = 1e7;

/// Reads `stop`. It comes with the place of its time.
pub(super) fn read(reader: &mut Reader<'_>, entry: &Entry) -> Option<Placed<Stop>> {
    let mut fields = Fields::of(reader, &entry.value, "a stop", entry.key.span)?;
    let time = fields.number(reader, &TIME);
    let loop_closed = fields.entry("loop_closed");
    fields.finish(reader);
    let Some(entry) = loop_closed else {
        let time = time?;
        return Some(Placed { value: Stop { time: time.value, loop_closed: None }, span: time.span });
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
    let loop_closed = Some(LoopClosed { within: within.value, after: after.value });
    Some(Placed { value: Stop { time: time.value, loop_closed }, span: time.span })
}

/// Checks that a run at `control_rate` (Hz) has no more ticks than can be kept.
pub(super) fn check(reader: &mut Reader<'_>, stop: &Placed<Stop>, control_rate: f64) {
    let ticks = stop.value.time * control_rate;
    if ticks <= MOST_TICKS {
        return;
    }
    let number = |count| format_si(count, Dimension::NUMBER);
    let rate = format_si(control_rate, Dimension::FREQUENCY);
    let label = format!("{} ticks at the control rate of {rate}", number(ticks));
    let message = format!("a run has at most {} ticks", number(MOST_TICKS));
    let longest = format_si(MOST_TICKS / control_rate, Dimension::TIME);
    let fault = Diagnostic::error(fault::TIMING, message, stop.span, label);
    reader.report(fault.hint(format!("for example `time: {longest}`, or a slower `control_rate`")));
}
