//! Reader of `mismatch`: the differences between the true array and the assumed one.

use std::f64::consts::FRAC_PI_2;

use super::fault;
use super::fields::Fields;
use super::key::Key;
use super::node::{Entry, Node, Placed};
use super::reader::Reader;
use super::scene::root_place;
use crate::mismatch::{Loss, Mismatch, Property, Range, Ranges};
use vibrissa_runtime::rig::Rig;
use vibrissa_runtime::units::Dimension;
use vibrissa_text::diagnostic::{Diagnostic, NotUtf8, Source, Span, utf8};

/// A key and its property.
type Keyed = (Property, Key);

const WHISKER: [Keyed; 8] = [
    relative(Property::Stiffness, "stiffness", "5 %"),
    relative(Property::Radius, "radius", "-1 %"),
    relative(Property::TipRadius, "tip_radius", "-5 %"),
    length(Property::Length, "length", "0.5 mm"),
    length(Property::TipAside, "tip_aside", "1 mm"),
    (Property::Links, Key::new("links", Dimension::NUMBER, (4.0, 64.0), "32")),
    relative(Property::Hinge, "hinge", "5 %"),
    (Property::Direction, Key::new("direction", Dimension::ANGLE, (-FRAC_PI_2, FRAC_PI_2), "1 deg")),
];
const BASE: [Keyed; 2] =
    [length(Property::BaseForward, "forward", "0.5 mm"), length(Property::BaseOutward, "outward", "0.5 mm")];
const SENSOR: [Keyed; 7] = [
    relative(Property::Gain, "gain", "2 %"),
    (Property::Cubic, Key::new("cubic", Dimension::NUMBER, (-10.0, 10.0), "1 %")),
    (Property::Offset, Key::new("offset", Dimension::ANGLE, (-1.0, 1.0), "2 urad")),
    (Property::Drift, Key::new("drift_per_minute", Dimension::ANGLE, (-1.0, 1.0), "5 urad")),
    (Property::Noise, Key::new("noise", Dimension::ANGLE, (0.0, 1.0), "0.5 urad")),
    (Property::Resolution, Key::new("resolution", Dimension::ANGLE, (0.0, 1.0), "0.034 urad")),
    time(Property::SensorLatency, "latency", "5 ms"),
];
const LOST: Keyed = (Property::Lost, Key::new("share", Dimension::NUMBER, (0.0, 1.0), "1 %"));
const POSE_NOISE: [Keyed; 2] = spread(Property::PoseNoise, Property::HeadingNoise);
const POSE_WANDER: [Keyed; 2] = spread(Property::PoseWander, Property::HeadingWander);
const WANDER_TIME: [Keyed; 1] = [(Property::WanderTime, Key::new("time", Dimension::TIME, (1e-3, 1e4), "1 s"))];
const POSE_LATENCY: [Keyed; 1] = [time(Property::PoseLatency, "latency", "10 ms")];
const COMMAND_LATENCY: [Keyed; 1] = [time(Property::CommandLatency, "latency", "33 ms")];
const PLATFORM: [Keyed; 2] = [
    (Property::Servo, Key::new("servo", Dimension::TIME, (1e-3, 10.0), "100 ms")),
    (Property::Friction, Key::new("friction", Dimension::NUMBER, (0.0, 10.0), "0.1")),
];

const fn relative(property: Property, name: &'static str, example: &'static str) -> Keyed {
    (property, Key::new(name, Dimension::NUMBER, (-0.9, 10.0), example))
}

const fn length(property: Property, name: &'static str, example: &'static str) -> Keyed {
    (property, Key::new(name, Dimension::LENGTH, (-0.1, 0.1), example))
}

/// A time that is at most a second.
const fn time(property: Property, name: &'static str, example: &'static str) -> Keyed {
    (property, Key::new(name, Dimension::TIME, (0.0, 1.0), example))
}

/// Standard deviations of a position and of a heading.
const fn spread(position: Property, heading: Property) -> [Keyed; 2] {
    [
        (position, Key::new("position", Dimension::LENGTH, (0.0, 0.1), "0.05 mm")),
        (heading, Key::new("heading", Dimension::ANGLE, (0.0, 0.5), "0.02 deg")),
    ]
}

/// Reads a file that has a mismatch alone.
///
/// # Errors
/// As for [`read`](super::read).
pub fn read_mismatch(source: &Source) -> Result<Mismatch, Vec<Diagnostic>> {
    let (tree, faults) = fault::parse(source, "mismatch")?;
    let mut files = |_: &str| Err("a file of a mismatch cannot name another file".to_owned());
    let mut reader = Reader::new(source, &mut files, faults);
    let hint = "write at least one key, such as `stiffness: 5 %`; see scenarios/mismatch/plausible.yaml";
    let place = root_place(&mut reader, &tree, "mismatch", hint);
    let mismatch = place.and_then(|place| read_tree(&mut reader, &tree, place));
    reader.finish(mismatch).map(|mismatch| Mismatch { file: Some(source.name.clone()), ..mismatch })
}

/// Reads the section of a scenario.
pub(super) fn read_section(reader: &mut Reader<'_>, entry: &Entry) -> Option<Mismatch> {
    read_tree(reader, &entry.value, entry.key.span)
}

/// Checks that the array of a mismatch at `place` can be simulated for this rig.
pub(super) fn check(reader: &mut Reader<'_>, mismatch: &Mismatch, rig: &Rig, place: Span) {
    let checked = if reader.is_quasi_static { mismatch.check_without_inertia(rig) } else { mismatch.check(rig) };
    if let Err(error) = checked {
        let fault = Diagnostic::error(fault::RIG, error.to_string(), place, "of this mismatch");
        reader.report(fault.hint("a mismatch describes the whiskers of the rig of the scenario"));
    }
}

fn read_tree(reader: &mut Reader<'_>, node: &Placed<Node>, place: Span) -> Option<Mismatch> {
    let mut fields = Fields::of(reader, node, "a mismatch", place)?;
    let mut mismatch = Mismatch::default();
    if let Some(entry) = fields.entry("seed") {
        mismatch.seed = reader.count(&entry.value, "seed", 0..=u64::MAX, 1);
    }
    let base = fields.entry("from").and_then(|entry| from_file(reader, entry));
    let common = &mut mismatch.common;
    whisker(reader, &mut fields, common);
    let sensor = |reader: &mut Reader<'_>, sensor: &mut Fields<'_>, ranges: &mut Ranges| {
        read_keys(reader, sensor, &SENSOR, ranges);
        let entry = sensor.entry("lost")?;
        let mut lost = Fields::of(reader, &entry.value, "the loss of readings", entry.key.span)?;
        read_keys(reader, &mut lost, &[LOST], ranges);
        let kind = lost.entry("kind").and_then(|kind| {
            let index = reader.choice(&kind.value, "a lost reading", &Loss::ALL.map(Loss::name))?;
            Loss::ALL.get(index).copied()
        });
        lost.finish(reader);
        kind
    };
    mismatch.loss = group(reader, &mut fields, "sensor", common, sensor).flatten();
    group(reader, &mut fields, "pose", common, |reader, pose, ranges| {
        group(reader, pose, "noise", ranges, |reader, noise, ranges| read_keys(reader, noise, &POSE_NOISE, ranges));
        group(reader, pose, "wander", ranges, |reader, wander, ranges| {
            read_keys(reader, wander, &POSE_WANDER, ranges);
            read_keys(reader, wander, &WANDER_TIME, ranges);
        });
        read_keys(reader, pose, &POSE_LATENCY, ranges);
    });
    group(reader, &mut fields, "command", common, |reader, command, ranges| {
        read_keys(reader, command, &COMMAND_LATENCY, ranges);
    });
    read_keys(reader, &mut fields, &PLATFORM, common);
    if let Some(entry) = fields.entry("whiskers") {
        single_whiskers(reader, entry, &mut mismatch);
    }
    fields.finish(reader);
    if let Some(base) = base {
        mismatch.complete(&base);
    }
    Some(mismatch)
}

/// Reads the file that a section names.
fn from_file(reader: &mut Reader<'_>, entry: &Entry) -> Option<Mismatch> {
    let path = reader.text(&entry.value)?;
    let found = reader.file(&path.value).and_then(|bytes| {
        let text = utf8(&bytes).map_err(|fault| format!("{fault}; {}", NotUtf8::ADVICE))?;
        let faults = |faults: Vec<Diagnostic>| faults.first().map_or_else(String::new, |fault| fault.message.clone());
        read_mismatch(&Source::new(path.value.as_str(), text)).map_err(faults)
    });
    found
        .map_err(|reason| {
            let fault = Diagnostic::error(fault::FILE, format!("cannot use `{}`", path.value), path.span, reason);
            reader.report(fault.hint("give the path of a mismatch, relative to the folder of the scenario"));
        })
        .ok()
}

/// Reads the properties of single whiskers.
fn single_whiskers(reader: &mut Reader<'_>, entry: &Entry, mismatch: &mut Mismatch) {
    let Node::Mapping(entries) = &entry.value.value else {
        reader.wrong_type(&entry.value, "a mapping", "write each whisker under its name, such as `r0: {length: 1 mm}`");
        return;
    };
    for Entry { key, value } in entries {
        let Some(mut fields) = Fields::of(reader, value, "the mismatch of a whisker", key.span) else { continue };
        let mut ranges = Ranges::default();
        whisker(reader, &mut fields, &mut ranges);
        group(reader, &mut fields, "sensor", &mut ranges, |reader, sensor, ranges| {
            read_keys(reader, sensor, &SENSOR, ranges);
        });
        fields.finish(reader);
        mismatch.whiskers.insert(key.value.clone(), ranges);
    }
}

/// Reads the properties of a shaft and its mounting.
fn whisker(reader: &mut Reader<'_>, fields: &mut Fields<'_>, ranges: &mut Ranges) {
    read_keys(reader, fields, &WHISKER, ranges);
    group(reader, fields, "base", ranges, |reader, base, ranges| read_keys(reader, base, &BASE, ranges));
}

/// Reads the mapping of the key `name`, if there is one.
fn group<T>(
    reader: &mut Reader<'_>,
    fields: &mut Fields<'_>,
    name: &'static str,
    ranges: &mut Ranges,
    read: impl FnOnce(&mut Reader<'_>, &mut Fields<'_>, &mut Ranges) -> T,
) -> Option<T> {
    let entry = fields.entry(name)?;
    let mut inner = Fields::of(reader, &entry.value, "this part of a mismatch", entry.key.span)?;
    let result = read(reader, &mut inner, ranges);
    inner.finish(reader);
    Some(result)
}

fn read_keys(reader: &mut Reader<'_>, fields: &mut Fields<'_>, keys: &[Keyed], ranges: &mut Ranges) {
    for (property, key) in keys {
        if let Some(range) = fields.entry(key.name).and_then(|entry| range(reader, &entry.value, key)) {
            ranges.set(*property, range);
        }
    }
}

/// Reads a value, or a list of the least and the greatest value.
fn range(reader: &mut Reader<'_>, node: &Placed<Node>, key: &Key) -> Option<Range> {
    let Node::List(items) = &node.value else { return reader.number(node, key).map(|number| number.value.into()) };
    let [least, greatest] = items.as_slice() else {
        let message = format!("expected 2 numbers, found {}", items.len());
        let fault =
            Diagnostic::error(fault::TYPE, message, reader.extent(node), "must be a least and a greatest value");
        reader.report(
            fault.hint(format!("write one value, such as `{}: {}`, or the ends of a range", key.name, key.example)),
        );
        return None;
    };
    let (least, greatest) = (reader.number(least, key), reader.number(greatest, key));
    let range = Range { least: least?.value, greatest: greatest?.value };
    if range.least > range.greatest {
        let message = format!("the range of `{}` is empty", key.name);
        let fault = Diagnostic::error(fault::RANGE, message, reader.extent(node), "the first value exceeds the second");
        reader.report(fault.hint("write the least value first"));
        return None;
    }
    Some(range)
}
