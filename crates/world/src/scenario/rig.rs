//! Reader of `rig`: the differences from the reference rig.

use super::fault;
use super::fields::Fields;
use super::key::Key;
use super::node::{Entry, Node, Placed};
use super::reader::Reader;
use super::{Files, root_place, timing, whisker};
use crate::physics::{Integrator, Physics, Preset, ShaftModel, Solver};
use vibrissa_runtime::rig::keys::platform::{
    CENTRE_OF_MASS, INERTIA, LENGTH, MASS, NOSE_WIDTH, SERVO, SPEED_LIMIT, TAIL_WIDTH, YAW_RATE_LIMIT, YAW_SERVO,
};
use vibrissa_runtime::rig::{Platform, Rig, YawController};
use vibrissa_runtime::units::{Dimension, format_si};
use vibrissa_text::diagnostic::{Diagnostic, Source, Span};

const YAW_PROPORTIONAL: Key = Key::new("proportional", Dimension::FREQUENCY, (0.0, 100.0), "2 Hz");
const YAW_INTEGRAL: Key = Key::new("integral", Dimension::new(0, 0, -2, 0), (0.0, 1000.0), "0.8 Hz^2");
const YAW_LIMIT: Key = Key::new("limit", Dimension::ANGULAR_SPEED, (1e-3, 100.0), "45 deg/s");

const CONTACT_TIME: Key = Key::new("contact_time", Dimension::TIME, (1e-6, 1.0), "3.33 ms");
const IMPEDANCE: Key = Key::new("contact_impedance", Dimension::NUMBER, (1e-4, 0.9999), "[0.95, 0.99, 0.1 mm]");
const IMPEDANCE_DEPTH: Key = Key::new("contact_impedance", Dimension::LENGTH, (1e-9, 0.1), "[0.95, 0.99, 0.1 mm]");
const FRICTION: Key = Key::new("friction", Dimension::NUMBER, (0.0, 10.0), "0.3");
const OBJECT_HEIGHT: Key = Key::new("object_height", Dimension::LENGTH, (1e-3, 10.0), "80 mm");
const PENETRATION_LIMIT: Key = Key::new("penetration_limit", Dimension::LENGTH, (1e-6, 0.1), "1 mm");

/// Reads a text that has a rig alone: the keys of `rig` in a scenario, or the key `rig` with them.
///
/// # Errors
/// As for [`read`](super::read).
pub fn read_rig(source: &Source, files: &mut Files<'_>) -> Result<Rig, Vec<Diagnostic>> {
    let (tree, faults) = fault::parse(source, "rig")?;
    let mut reader = Reader::new(source, files, faults);
    let hint = "write at least one key, such as `preset: reference`; see docs/rig.md";
    let place = root_place(&mut reader, &tree, "rig", hint);
    let rig = place.and_then(|place| match &tree.value {
        // Copied from a scenario.
        Node::Mapping(entries)
            if let [entry] = entries.as_slice()
                && entry.key.value == "rig" =>
        {
            read(&mut reader, entry)
        }
        _ => read_tree(&mut reader, &tree, place),
    });
    reader.finish(rig.map(|(rig, _)| rig))
}

/// Reads `rig` and its physics settings. Omitted keys have the values of the preset, by default those of the reference
/// rig.
pub(super) fn read(reader: &mut Reader<'_>, entry: &Entry) -> Option<(Rig, Physics)> {
    read_tree(reader, &entry.value, entry.key.span)
}

fn read_tree(reader: &mut Reader<'_>, node: &Placed<Node>, place: Span) -> Option<(Rig, Physics)> {
    let fault_count = reader.fault_count();
    let mut fields = Fields::of(reader, node, "a rig", place)?;
    let preset = fields.entry("preset").and_then(|entry| {
        let index = reader.choice(&entry.value, "a preset", &Preset::ALL.map(Preset::name));
        index.and_then(|index| Preset::ALL.get(index)).copied()
    });
    let (mut rig, mut physics) = preset.unwrap_or_default().rig();
    if let Some(entry) = fields.entry("platform") {
        platform(reader, entry, &mut rig.platform);
    }
    if let Some(entry) = fields.entry("whiskers") {
        rig.whiskers = whisker::read_all(reader, entry, &rig.whiskers).unwrap_or_default();
    }
    let mut places = timing::TimingSpans::default();
    if let Some(entry) = fields.entry("physics") {
        places.step = read_physics(reader, entry, &mut physics);
    }
    if let Some(entry) = fields.entry("sensing") {
        timing::read_sensing(reader, entry, &mut rig.sensing, &mut places);
    }
    fields.finish(reader);
    if reader.fault_count() == fault_count {
        timing::check(reader, &rig, &mut physics, places);
    }
    // An incomplete rig would cause misleading diagnostics in the checks of the whole scene.
    (reader.fault_count() == fault_count).then_some((rig, physics))
}

fn platform(reader: &mut Reader<'_>, entry: &Entry, platform: &mut Platform) {
    let Some(mut fields) = Fields::of(reader, &entry.value, "a platform", entry.key.span) else { return };
    fields.set(reader, &TAIL_WIDTH, &mut platform.tail_width);
    fields.set(reader, &NOSE_WIDTH, &mut platform.nose_width);
    let length = fields.set(reader, &LENGTH, &mut platform.length);
    let centre_of_mass = fields.set(reader, &CENTRE_OF_MASS, &mut platform.centre_of_mass);
    fields.set(reader, &MASS, &mut platform.mass);
    fields.set(reader, &INERTIA, &mut platform.inertia);
    fields.set(reader, &SERVO, &mut platform.servo);
    if let Some(entry) = fields.entry(YAW_SERVO.name)
        && let Some(time) = reader.number(&entry.value, &YAW_SERVO)
    {
        platform.yaw_servo = Some(time.value);
    }
    fields.set(reader, &SPEED_LIMIT, &mut platform.speed_limit);
    fields.set(reader, &YAW_RATE_LIMIT, &mut platform.yaw_rate_limit);
    if let Some(entry) = fields.entry("yaw") {
        yaw(reader, entry, &mut platform.yaw);
    }
    fields.finish(reader);
    if platform.centre_of_mass > platform.length
        && let Some(place) = centre_of_mass.or(length)
    {
        let (ahead, length) = (platform.centre_of_mass, platform.length);
        let label = format!(
            "the centre of mass is {} ahead of the tail, and the platform {} long",
            format_si(ahead, Dimension::LENGTH),
            format_si(length, Dimension::LENGTH)
        );
        let fault = Diagnostic::error(fault::RIG, "the centre of mass is in front of the platform", place, label);
        reader.report(fault.hint("give `length` and `centre_of_mass`, the second from 0 mm to the first"));
    }
}

fn yaw(reader: &mut Reader<'_>, entry: &Entry, yaw: &mut YawController) {
    let Some(mut fields) = Fields::of(reader, &entry.value, "the yaw controller", entry.key.span) else { return };
    fields.set(reader, &YAW_PROPORTIONAL, &mut yaw.proportional);
    fields.set(reader, &YAW_INTEGRAL, &mut yaw.integral);
    fields.set(reader, &YAW_LIMIT, &mut yaw.limit);
    fields.finish(reader);
}

/// Reads `physics`, and returns the span of the step if it is given.
fn read_physics(reader: &mut Reader<'_>, entry: &Entry, physics: &mut Physics) -> Option<Span> {
    let mut fields = Fields::of(reader, &entry.value, "the physics", entry.key.span)?;
    let step = fields.set(reader, &timing::STEP, &mut physics.step);
    if let Some(entry) = fields.entry("whiskers")
        && let Some(index) = reader.choice(&entry.value, "a model of the whiskers", &["planar", "spatial"])
        && index == 1
    {
        spatial(reader, entry, physics);
    }
    fields.set(reader, &OBJECT_HEIGHT, &mut physics.object_height);
    if let Some(entry) = fields.entry("integrator") {
        let index = reader.choice(&entry.value, "an integrator", &Integrator::ALL.map(Integrator::name));
        physics.integrator = index.and_then(|index| Integrator::ALL.get(index)).copied().unwrap_or_default();
    }
    if let Some(entry) = fields.entry("solver") {
        let index = reader.choice(&entry.value, "a solver", &Solver::ALL.map(Solver::name));
        physics.solver = index.and_then(|index| Solver::ALL.get(index)).copied().unwrap_or_default();
    }
    fields.set(reader, &timing::CALM_STEP, &mut physics.calm_step);
    if let Some(entry) = fields.entry("rigid_in_air")
        && let Some(rigid) = reader.flag(&entry.value)
    {
        physics.rigid_in_air = rigid;
    }
    fields.set(reader, &CONTACT_TIME, &mut physics.contact_time);
    if let Some(entry) = fields.entry(IMPEDANCE.name)
        && let Some(items) = reader.triple(&entry.value, IMPEDANCE.example)
    {
        let keys = [&IMPEDANCE, &IMPEDANCE, &IMPEDANCE_DEPTH];
        for ((item, key), target) in items.iter().zip(keys).zip(&mut physics.contact_impedance) {
            if let Some(number) = reader.number(item, key) {
                *target = number.value;
            }
        }
    }
    fields.set(reader, &FRICTION, &mut physics.friction);
    fields.set(reader, &PENETRATION_LIMIT, &mut physics.penetration_limit);
    fields.finish(reader);
    step
}

/// Selects whiskers that bend out of the plane. `entry` is the key that asks for them.
fn spatial(reader: &mut Reader<'_>, entry: &Entry, physics: &mut Physics) {
    if physics.shafts == ShaftModel::Chain {
        physics.shafts = ShaftModel::SpatialChain;
        return;
    }
    let label = "the preset has cables";
    let fault = Diagnostic::error(fault::RIG, "cables have no spatial model under gravity", entry.value.span, label);
    reader.report(fault.hint("leave out `preset: peer_cable`, or this key"));
}
