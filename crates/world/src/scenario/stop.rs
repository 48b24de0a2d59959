//! Reader of `stop`: the stop condition of a run.

use super::fault;
use super::reader::Reader;
use super::start::POSITION;
use crate::scene::{LoopClosed, Reached, Stalled, Stop};
use vibrissa_runtime::units::{Dimension, Key, format_si};
use vibrissa_text::diagnostic::{Diagnostic, Span};
use vibrissa_yaml::{Entry, Fields, Placed};

const TIME: Key = Key::new("time", Dimension::TIME, (1e-3, 86_400.0), "120 s");
const WITHIN: Key = Key::new("within", Dimension::LENGTH, (1e-6, 1.0), "5 mm");
const AFTER: Key = Key::new("after", Dimension::TIME, (0.0, 86_400.0), "5 s");
const PASSED: Key = Key::new("passed", Dimension::NUMBER, (0.01, 0.99), "95 %");
const STALLED_AFTER: Key = Key::new("after", Dimension::TIME, (0.1, 86_400.0), "60 s");
const PLACE: Key = Key { name: "place", example: "[0.5 m, 1.6 m]", ..POSITION };

/// The largest number of control ticks of a run, because the trace contains every tick: ninety hours at 30 Hz.
const MAX_TICKS: f64 = 1e7;

/// A stop condition, with the spans of its time and of its passage.
pub(super) struct PlacedStop {
    pub(super) value: Stop,
    time: Span,
    passed: Option<Span>,
}

/// Reads `stop`.
pub(super) fn read(reader: &mut Reader<'_>, entry: &Entry) -> Option<PlacedStop> {
    let mut fields = Fields::of(reader, &entry.value, "a stop", entry.key.span)?;
    let time = fields.number(reader, &TIME);
    let mut share = f64::NAN;
    let passed = fields.set(reader, &PASSED, &mut share);
    let entries = ["loop_closed", "reached", "mapped", "succeeded", "stalled"].map(|name| fields.entry(name));
    let [loop_closed, reached, mapped, succeeded, stalled] = entries;
    fields.finish(reader);
    // An invalid key has been reported, so the scenario is rejected anyway.
    let loop_closed = loop_closed.and_then(|entry| read_loop_closed(reader, entry, time.as_ref()));
    let reached = reached.and_then(|entry| read_reached(reader, entry, time.as_ref()));
    let mapped = mapped.and_then(|entry| reader.flag(&entry.value)).unwrap_or_default();
    let succeeded = succeeded.and_then(|entry| reader.flag(&entry.value)).unwrap_or_default();
    let stalled = stalled.and_then(|entry| read_stalled(reader, entry));
    let time = time?;
    // A run without a goal need not make progress.
    let has_aim = loop_closed.is_some() || reached.is_some() || passed.is_some() || mapped || succeeded;
    let stalled = stalled.or_else(|| has_aim.then(Stalled::default));
    let passed_share = passed.map(|_| share);
    let stop = Stop { time: time.value, loop_closed, reached, passed: passed_share, mapped, succeeded, stalled };
    Some(PlacedStop { value: stop, time: time.span, passed })
}

fn read_loop_closed(reader: &mut Reader<'_>, entry: &Entry, end: Option<&Placed<f64>>) -> Option<LoopClosed> {
    let mut fields = Fields::of(reader, &entry.value, "`loop_closed`", entry.key.span)?;
    let within = fields.number(reader, &WITHIN);
    let after = fields.number(reader, &AFTER);
    fields.finish(reader);
    let (within, after) = (within?, after?);
    is_in_time(reader, "the run ends before the loop can close", &after, end)?;
    Some(LoopClosed { within: within.value, after: after.value })
}

fn read_reached(reader: &mut Reader<'_>, entry: &Entry, end: Option<&Placed<f64>>) -> Option<Reached> {
    let mut fields = Fields::of(reader, &entry.value, "`reached`", entry.key.span)?;
    let place = fields.required(PLACE.name, PLACE.example).and_then(|entry| reader.point(&entry.value, &PLACE));
    let within = fields.number(reader, &WITHIN);
    let after = fields.number(reader, &AFTER);
    fields.finish(reader);
    let (place, within, after) = (place?, within?, after?);
    is_in_time(reader, "the run ends before the position can be reached", &after, end)?;
    Some(Reached { place: place.value, within: within.value, after: after.value })
}

fn read_stalled(reader: &mut Reader<'_>, entry: &Entry) -> Option<Stalled> {
    let mut stalled = Stalled::default();
    let mut fields = Fields::of(reader, &entry.value, "a stall", entry.key.span)?;
    fields.set(reader, &WITHIN, &mut stalled.within);
    fields.set(reader, &STALLED_AFTER, &mut stalled.after);
    fields.finish(reader);
    Some(stalled)
}

/// Reports a condition that cannot hold before the end of the run.
fn is_in_time(reader: &mut Reader<'_>, never: &str, after: &Placed<f64>, end: Option<&Placed<f64>>) -> Option<()> {
    let end = end?;
    if after.value < end.value {
        return Some(());
    }
    let label = format!("the run ends at {}", format_si(end.value, Dimension::TIME));
    let fault = Diagnostic::error(fault::TIMING, never, after.span, label);
    reader.report(fault.note(end.span, "the end of the run").hint("make `after` shorter than `time`"));
    None
}

/// Reports a passage through no tunnel.
pub(super) fn check_passage(reader: &mut Reader<'_>, stop: &PlacedStop, has_tunnel: bool) {
    if let Some(place) = stop.passed.filter(|_| !has_tunnel) {
        let message = "there is no tunnel that could be passed";
        let fault = Diagnostic::error(fault::SHAPE, message, place, "a share of a tunnel's axis");
        reader.report(fault.hint("add an object `tunnel`, or end the run by `loop_closed` or `reached`"));
    }
}

/// Checks that a run at `control_rate` (Hz) does not exceed the largest number of ticks.
pub(super) fn check(reader: &mut Reader<'_>, stop: &PlacedStop, control_rate: f64) {
    let ticks = stop.value.time * control_rate;
    if ticks <= MAX_TICKS {
        return;
    }
    let number = |count| format_si(count, Dimension::NUMBER);
    let rate = format_si(control_rate, Dimension::FREQUENCY);
    let label = format!("{} ticks at the control rate of {rate}", number(ticks));
    let message = format!("a run has at most {} ticks", number(MAX_TICKS));
    let longest = format_si(MAX_TICKS / control_rate, Dimension::TIME);
    let fault = Diagnostic::error(fault::TIMING, message, stop.time, label);
    reader.report(fault.hint(format!("for example `time: {longest}`, or a slower `control_rate`")));
}
