//! A scenario as a whole.

use super::fields::Fields;
use super::node::{Entry, Node, Placed};
use super::reader::Reader;
use super::{expect, fault, object, rig, start, stop};
use crate::diagnostic::{Diagnostic, Source, Span};
use crate::geometry::{Contour, Pose};
use crate::rig::Rig;
use crate::scene::Scene;
use crate::scene::clearance::{Overlap, overlap};
use crate::scene::solid::{Solid, SolidError};
use std::path::PathBuf;

/// Reads a scenario. The list of faults is never empty, and in the order of the text.
pub(in crate::scene) fn read(source: &Source) -> Result<Scene, Vec<Diagnostic>> {
    let (tree, faults) = fault::parse(source)?;
    let mut reader = Reader::new(source, faults);
    let scene = read_scene(&mut reader, &tree);
    let faults = reader.into_faults();
    match scene {
        Some(scene) if faults.is_empty() => Ok(scene),
        _ => Err(faults),
    }
}

fn read_scene(reader: &mut Reader<'_>, tree: &Placed<Node>) -> Option<Scene> {
    let place = match &tree.value {
        Node::Mapping(entries) => entries.first().map_or(tree.span, |first| first.key.span),
        Node::Null => {
            let fault = Diagnostic::error(fault::EMPTY, "the scenario is empty", tree.span, "nothing here");
            reader.report(fault.hint("write at least `name`, `object`, `start` and `stop`; see scenarios/disk.yaml"));
            return None;
        }
        _ => tree.span,
    };
    let mut fields = Fields::of(reader, tree, "a scenario", place)?;
    let name = fields.required("name", "disk").and_then(|entry| name(reader, entry));
    let description = match fields.entry("description") {
        Some(entry) => reader.text(&entry.value).map(|text| text.value),
        None => Some(String::new()),
    };
    let rig = match fields.entry("rig") {
        Some(entry) => rig::read(reader, entry),
        None => Some(Rig::default()),
    };
    let example = "{circle: {centre: [40 cm, 40 cm], radius: 30 cm}}";
    let object = fields.required("object", example).and_then(|entry| object::read(reader, entry));
    let start = fields.required("start", "{position: [0 mm, 72 mm], heading: 90 deg}");
    let start = start.and_then(|entry| start::pose(reader, entry, "a start"));
    let stop = fields.required("stop", "{time: 120 s}").and_then(|entry| stop::read(reader, entry));
    let expect = match fields.entry("expect") {
        Some(entry) => expect::read(reader, entry),
        None => Some(vec![expect::COMPLETION]),
    };
    let policy = match fields.entry("policy") {
        Some(entry) => policy(reader, entry).map(Some),
        None => Some(None),
    };
    let seed = match fields.entry("seed") {
        Some(entry) => reader.count(&entry.value, "seed", 0..=u64::MAX, 1),
        None => Some(0),
    };
    fields.finish(reader);

    if let Some(object) = &object {
        check_solid(reader, object);
    }
    if let (Some(rig), Some(stop)) = (&rig, &stop) {
        stop::check(reader, stop, rig.sensing.control_rate);
    }
    let (rig, object, start) = (rig?, object?, start?);
    check_clearance(reader, &rig, &start, &object);
    Some(Scene {
        name: name?,
        description: description?,
        rig,
        object: object.value,
        start: start.value,
        stop: stop?.value,
        expect: expect?,
        policy: policy?,
        seed: seed?,
    })
}

fn name(reader: &mut Reader<'_>, entry: &Entry) -> Option<String> {
    let name = reader.text(&entry.value)?;
    let is_fit = |letter: char| letter.is_ascii_alphanumeric() || matches!(letter, '_' | '-');
    if name.value.is_empty() || name.value.len() > 64 || !name.value.chars().all(is_fit) {
        let message = format!("a scenario cannot be called `{}`", name.value);
        let label = "must be 1 to 64 letters, digits, _ and -";
        let fault = Diagnostic::error(fault::NAME, message, name.span, label);
        reader.report(fault.hint("results are filed under this name; the `description` takes any text"));
        return None;
    }
    Some(name.value)
}

fn policy(reader: &mut Reader<'_>, entry: &Entry) -> Option<PathBuf> {
    let path = reader.text(&entry.value)?;
    if path.value.is_empty() {
        let fault = Diagnostic::error(fault::NAME, "the path of the policy is empty", path.span, "must be a path");
        reader.report(fault.hint("write it relative to this file, or leave `policy` out"));
        return None;
    }
    Some(path.value.into())
}

fn check_solid(reader: &mut Reader<'_>, object: &Placed<Contour>) {
    let (message, label, hint) = match Solid::from_contour(&object.value) {
        Ok(_) => return,
        Err(SolidError::Open) => {
            ("the object has no inside", "an open contour".to_owned(), "close it with `closed: true`")
        }
        Err(SolidError::Concave) => (
            "the object is concave",
            "turns both ways".to_owned(),
            "one solid can only be convex yet; fill the hollows",
        ),
        Err(SolidError::Corners { count, limit }) => (
            "the object has too many corners to be simulated",
            format!("{count} corners, must be at most {limit}"),
            "leave out vertices that hardly turn, or use arcs",
        ),
    };
    reader.report(Diagnostic::error(fault::SHAPE, message, object.span, label).hint(hint));
}

fn check_clearance(reader: &mut Reader<'_>, rig: &Rig, start: &Placed<Pose>, object: &Placed<Contour>) {
    let report = |reader: &mut Reader<'_>, part: String, place: Span| {
        let message = format!("{part} starts in the object");
        let fault = Diagnostic::error(fault::OVERLAP, message, start.span, "the rig starts here");
        reader.report(fault.note(place, "inside or touching this").hint("move `position` away from the object"));
    };
    match overlap(rig, &start.value, &object.value) {
        None => {}
        Some(Overlap::Platform) => report(reader, "the platform".to_owned(), object.span),
        Some(Overlap::Whisker(index)) => {
            let name = rig.whiskers.get(index).map_or("", |whisker| whisker.name.as_str());
            report(reader, format!("whisker `{name}`"), object.span);
        }
    }
}
