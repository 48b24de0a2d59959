//! Reader of `tunnel`: two walls along a centre line.

use super::fault;
use super::reader::Reader;
use super::start::{self, HEADING};
use crate::geometry::{CentreLine, Corners, Opening, Pose, Tunnel};
use vibrissa_runtime::units::{Dimension, Key};
use vibrissa_text::diagnostic::Diagnostic;
use vibrissa_yaml::{Entry, Fields, Node, Placed};

const WIDTH: Key = Key::new("width", Dimension::LENGTH, (1e-3, 10.0), "225 mm");
const THICKNESS: Key = Key::new("thickness", Dimension::LENGTH, (1e-4, 10.0), "20 mm");
const LENGTH: Key = Key::new("length", Dimension::LENGTH, (1e-3, 100.0), "25 cm");
const AMPLITUDE: Key = Key::new("amplitude", Dimension::LENGTH, (-10.0, 10.0), "10 cm");
const WAVE_NUMBER: Key = Key::new("wave_number", Dimension::new(-1, 1, 0, 0), (1e-3, 1e3), "4 rad/m");
const RADIUS: Key = Key::new("radius", Dimension::LENGTH, (1e-2, 100.0), "0.89 m");
const FROM: Key = Key::new("from", Dimension::NUMBER, (0.0, 1.0), "6 %");
const TO: Key = Key::new("to", Dimension::NUMBER, (0.0, 1.0), "10 %");
const FUNNEL_LENGTH: Key = Key::new("length", Dimension::NUMBER, (1e-3, 1.0), "10 %");
const FUNNEL_DEPTH: Key = Key::new("depth", Dimension::LENGTH, (0.0, 10.0), "50 mm");

const RUNS: &str = "[{length: 25 cm, heading: 30 deg}, {length: 25 cm, heading: 0 deg}]";

/// Reads a tunnel.
pub(super) fn read(reader: &mut Reader<'_>, entry: &Entry) -> Option<Tunnel> {
    let mut fields = Fields::of(reader, &entry.value, "a tunnel", entry.key.span)?;
    let frame = match fields.entry("frame") {
        Some(entry) => start::pose(reader, entry, "the frame of a tunnel").map(|frame| frame.value),
        None => Some(Pose::default()),
    };
    let line = fields.required("centre_line", "{sine: {amplitude: 10 cm, wave_number: 4 rad/m, length: 1.5 m}}");
    let line = line.and_then(|entry| centre_line(reader, entry));
    let width = fields.number(reader, &WIDTH);
    let thickness = fields.number(reader, &THICKNESS);
    fields.finish(reader);
    let (line, width, thickness, frame) = (line?, width?, thickness?, frame?);
    if thickness.value >= width.value {
        let fault = Diagnostic::error(
            fault::SHAPE,
            "the walls of the tunnel leave no free width",
            thickness.span,
            "at least as thick as the tunnel is wide",
        );
        let fault = fault.note(width.span, "the distance between the centre lines of the walls");
        reader.report(fault.hint("make the walls thinner, or the tunnel wider"));
        return None;
    }
    reader.make(line.most_pieces(width.value), entry.key.span)?;
    match Tunnel::new(&line, width.value, thickness.value, &frame) {
        Ok(tunnel) => Some(tunnel),
        Err(error) => {
            let fault = Diagnostic::error(
                fault::SHAPE,
                "a tunnel with these values is not possible",
                entry.key.span,
                error.to_string(),
            );
            reader.report(fault.hint("change the values of the tunnel"));
            None
        }
    }
}

fn centre_line(reader: &mut Reader<'_>, entry: &Entry) -> Option<CentreLine> {
    let kinds = ["polyline", "mitred", "sine", "polar"];
    let example = "sine: {amplitude: 10 cm, wave_number: 4 rad/m, length: 1.5 m}";
    let (kind, entry) = reader.variant(&entry.value, "a centre line", &kinds, example)?;
    match kind {
        "polyline" => polyline(reader, entry, Corners::AtDistance),
        "mitred" => polyline(reader, entry, Corners::Mitred),
        "sine" => sine(reader, entry),
        _ => polar(reader, entry),
    }
}

fn polyline(reader: &mut Reader<'_>, entry: &Entry, corners: Corners) -> Option<CentreLine> {
    let example = format!("{}: {RUNS}", entry.key.value);
    let items = reader.items(&entry.value, "a list of runs", &example)?;
    if items.is_empty() {
        let fault = Diagnostic::error(fault::SHAPE, "the centre line has no straight run", entry.key.span, "empty");
        reader.report(fault.hint(format!("for example `{example}`")));
        return None;
    }
    let runs: Vec<_> = items.iter().map(|item| run(reader, entry, item)).collect();
    Some(CentreLine::Polyline { runs: runs.into_iter().collect::<Option<_>>()?, corners })
}

fn run(reader: &mut Reader<'_>, entry: &Entry, item: &Placed<Node>) -> Option<(f64, f64)> {
    let mut fields = Fields::of(reader, item, "a run", entry.key.span)?;
    let length = fields.number(reader, &LENGTH);
    let heading = fields.number(reader, &HEADING);
    fields.finish(reader);
    Some((length?.value, heading?.value))
}

fn sine(reader: &mut Reader<'_>, entry: &Entry) -> Option<CentreLine> {
    let mut fields = Fields::of(reader, &entry.value, "a sine", entry.key.span)?;
    let amplitude = fields.number(reader, &AMPLITUDE);
    let wave_number = fields.number(reader, &WAVE_NUMBER);
    let length = fields.number(reader, &LENGTH);
    fields.finish(reader);
    Some(CentreLine::Sine { amplitude: amplitude?.value, wave_number: wave_number?.value, length: length?.value })
}

fn polar(reader: &mut Reader<'_>, entry: &Entry) -> Option<CentreLine> {
    let mut fields = Fields::of(reader, &entry.value, "a polar line", entry.key.span)?;
    let radius = fields.number(reader, &RADIUS);
    let amplitude = fields.number(reader, &AMPLITUDE);
    let waves = fields.required("waves", "5").and_then(|entry| reader.count(&entry.value, "waves", 0..=100, 5));
    let example = "{from: 6 %, to: 10 %, funnel: {length: 10 %, depth: 50 mm}}";
    let opening = fields.required("opening", example).and_then(|entry| opening(reader, entry));
    fields.finish(reader);
    let (radius, amplitude) = (radius?.value, amplitude?.value);
    Some(CentreLine::Polar { radius, amplitude, waves: waves?, opening: opening? })
}

fn opening(reader: &mut Reader<'_>, entry: &Entry) -> Option<Opening> {
    let mut fields = Fields::of(reader, &entry.value, "an opening", entry.key.span)?;
    let from = fields.number(reader, &FROM);
    let to = fields.number(reader, &TO);
    let funnel = fields.required("funnel", "{length: 10 %, depth: 50 mm}");
    fields.finish(reader);
    let entry = funnel?;
    let mut fields = Fields::of(reader, &entry.value, "a funnel", entry.key.span)?;
    let length = fields.number(reader, &FUNNEL_LENGTH);
    let depth = fields.number(reader, &FUNNEL_DEPTH);
    fields.finish(reader);
    let (from, to) = (from?.value, to?.value);
    Some(Opening { from, to, funnel_length: length?.value, funnel_depth: depth?.value })
}
