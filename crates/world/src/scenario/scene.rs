//! The root of a scenario.

use super::objects::Objects;
use super::reader::Reader;
use super::{expect, fault, mismatch, object, policy, rig, start, stop};
use crate::physics::Physics;
use crate::scenario::Files;
use crate::scene::{Scene, WorldKind};
use vibrissa_runtime::rig::Rig;
use vibrissa_text::diagnostic::{Diagnostic, Source};
use vibrissa_yaml::{Entry, Fields, Node, Placed, parse, root_place};

const NAME_HINT: &str = "results are filed under this name; the `description` takes any text";

/// Reads a scenario. A list of diagnostics is never empty and has the order of the text.
pub(super) fn read(source: &Source, files: &mut Files<'_>) -> Result<Scene, Vec<Diagnostic>> {
    let (tree, faults) = parse(source, "scenario")?;
    let mut reader = Reader::new(source, files, faults);
    let scene = read_scene(&mut reader, &tree);
    reader.finish(scene)
}

pub(super) fn read_scene(reader: &mut Reader<'_>, tree: &Placed<Node>) -> Option<Scene> {
    let hint = "write at least `name`, `objects`, `start` and `stop`; see scenarios/disk.yaml";
    let place = root_place(reader, tree, "scenario", hint)?;
    if let Some(draw) = tree.entry("draw") {
        let message = "this file describes a family of scenes";
        let fault = Diagnostic::error(fault::UNKNOWN_KEY, message, draw.key.span, "draws values");
        reader.report(fault.hint("`vibrissa families FILE` runs it, and `--print --trial 0` writes one scene"));
        return None;
    }
    let mut fields = Fields::of(reader, tree, "a scenario", place)?;
    let name = fields.required("name", "disk").and_then(|entry| name(reader, entry, "a scenario", NAME_HINT));
    let description = match fields.entry("description") {
        Some(entry) => reader.text(&entry.value).map(|text| text.value),
        None => Some(String::new()),
    };
    let mujoco = WorldKind::Mujoco.name();
    reader.is_mujoco = matches!(fields.peek("world"), Some(Node::Text(world)) if world == mujoco);
    let rig = match fields.entry("rig") {
        Some(entry) => rig::read(reader, entry),
        None => Some((Rig::default(), Physics::default())),
    };
    let mismatch = match fields.entry("mismatch") {
        Some(entry) => mismatch::read_section(reader, entry).map(|mismatch| Some((mismatch, entry.key.span))),
        None => Some(None),
    };
    let objects = fields.required("objects", object::EXAMPLE).and_then(|entry| object::read_all(reader, entry));
    let start = fields.required("start", "{position: [0 mm, 72 mm], heading: 90 deg}");
    let start = start.and_then(|entry| start::pose(reader, entry, "a start"));
    let stop = fields.required("stop", "{time: 120 s}").and_then(|entry| stop::read(reader, entry));
    let expect = match fields.entry("expect") {
        Some(entry) => expect::read(reader, entry),
        None => Some(expect::default(stop.as_ref().map(|stop| &stop.value))),
    };
    let policy = match fields.entry("policy") {
        Some(entry) => policy::read(reader, &entry.value).map(Some),
        None => Some(None),
    };
    let world = match fields.entry("world") {
        Some(entry) => {
            let index = reader.choice(&entry.value, "a simulator", &WorldKind::ALL.map(WorldKind::name));
            index.and_then(|index| WorldKind::ALL.get(index)).copied().map(Some)
        }
        None => Some(None),
    };
    let seed = match fields.entry("seed") {
        Some(entry) => reader.count(&entry.value, "seed", 0..=u64::MAX, 1),
        None => Some(0),
    };
    fields.finish(reader);

    let objects = objects.and_then(|objects| Objects::of(reader, objects));
    if let (Some((rig, _)), Some(Some((mismatch, place)))) = (&rig, &mismatch) {
        mismatch::check(reader, mismatch, rig, *place);
    }
    if let (Some((rig, _)), Some(stop)) = (&rig, &stop) {
        stop::check(reader, stop, rig.sensing.control_rate);
    }
    if let (Some(objects), Some(stop)) = (&objects, &stop) {
        stop::check_passage(reader, stop, objects.has_tunnel());
    }
    let ((rig, physics), objects, start) = (rig?, objects?, start?);
    objects.check_clearance(reader, &rig, &start);
    Some(Scene {
        name: name?,
        description: description?,
        rig,
        mismatch: mismatch?.map(|(mismatch, _)| mismatch),
        self_calibration: None,
        physics,
        truth: objects.truth()?,
        solids: objects.into_solids(),
        start: start.value,
        stop: stop?.value,
        expect: expect?,
        policy: policy?,
        world: world?,
        seed: seed?,
    })
}

/// Reads the name of `what`, which must be a valid file name.
pub fn name(reader: &mut vibrissa_yaml::Reader<'_>, entry: &Entry, what: &str, hint: &'static str) -> Option<String> {
    let name = reader.text(&entry.value)?;
    let is_fit = |letter: char| letter.is_ascii_alphanumeric() || matches!(letter, '_' | '-');
    if name.value.is_empty() || name.value.len() > 64 || !name.value.chars().all(is_fit) {
        let message = format!("{what} cannot be called `{}`", name.value);
        let label = "must be 1 to 64 letters, digits, _ and -";
        let fault = Diagnostic::error(fault::NAME, message, name.span, label);
        reader.report(fault.hint(hint));
        return None;
    }
    Some(name.value)
}
