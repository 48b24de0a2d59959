//! Reader of `rig.whiskers`: the whiskers by name.

use super::calibration::read_calibration;
use super::fault;
use super::fields::Fields;
use super::key::Key;
use super::node::{Entry, Node};
use super::reader::Reader;
use crate::physics::{MIN_INERTIA, link_inertia};
use std::f64::consts::FRAC_PI_4;
use std::ops::RangeInclusive;
use vibrissa_runtime::calibration::Calibration;
use vibrissa_runtime::rig::keys::whisker::{
    BASE, DAMPING, DIRECTION, HINGE_ARMATURE, HINGE_STIFFNESS, LENGTH, RADIUS, YOUNG_MODULUS,
};
use vibrissa_runtime::rig::{Hinge, Shaft, Whisker};
use vibrissa_runtime::signal::MAX_WHISKERS;
use vibrissa_runtime::units::{Dimension, format_si};
use vibrissa_text::diagnostic::{Diagnostic, NotUtf8, Span, utf8};

const PITCH: Key = Key::new("pitch", Dimension::ANGLE, (-FRAC_PI_4, FRAC_PI_4), "1.2 deg");

const TIP_RADIUS: Key = Key::new("tip_radius", Dimension::LENGTH, (1e-6, 1e-2), "0.05 mm");
const DENSITY: Key = Key::new("density", Dimension::DENSITY, (1.0, 1e5), "6450 kg/m^3");
const OUT_OF_PLANE: Key = Key::new("out_of_plane", Dimension::NUMBER, (1e-3, 1e3), "4");
const LINKS: RangeInclusive<usize> = 4..=64;

const HINGE_DAMPING: Key = Key::new("damping", Dimension::TORSION_DAMPING, (0.0, 1e3), "0.01 N m s/rad");

/// Reads the whiskers. Omitted keys have the values of the whisker with the same name in the `preset` rig. A whisker
/// with a new name requires a position and a direction.
pub(super) fn read_all(reader: &mut Reader<'_>, entry: &Entry, preset: &[Whisker]) -> Option<Vec<Whisker>> {
    let entries = match &entry.value.value {
        Node::Mapping(entries) if !entries.is_empty() => entries,
        Node::Mapping(_) => {
            let fault = Diagnostic::error(fault::RIG, "the rig has no whisker", entry.key.span, "empty");
            reader
                .report(fault.hint("add a whisker, such as `r0: {}`, or leave `whiskers` out for the reference pair"));
            return None;
        }
        _ => {
            reader.wrong_type(
                &entry.value,
                "a mapping",
                "write each whisker under its name, such as `r0: {length: 75 mm}`",
            );
            return None;
        }
    };
    if let Some(extra) = entries.get(MAX_WHISKERS) {
        let message = format!("a rig can have {MAX_WHISKERS} whiskers at most");
        reader.report(Diagnostic::error(fault::RIG, message, extra.key.span, "one too many").hint("leave some out"));
        return None;
    }
    let whiskers: Vec<Option<Whisker>> = entries.iter().map(|entry| read(reader, entry, preset)).collect();
    whiskers.into_iter().collect()
}

fn read(reader: &mut Reader<'_>, entry: &Entry, preset: &[Whisker]) -> Option<Whisker> {
    let name = &entry.key;
    let is_identifier = name.value.starts_with(|first: char| first.is_ascii_alphabetic())
        && name.value.chars().all(|letter| letter.is_ascii_alphanumeric() || letter == '_');
    if !is_identifier {
        let message = format!("a whisker cannot be called `{}`", name.value);
        let label = "must be letters, digits and _, a letter first";
        let fault = Diagnostic::error(fault::NAME, message, name.span, label);
        reader.report(fault.hint("policies bind to whiskers by name, such as r0 for the first on the right"));
    }

    let reference = preset.iter().find(|whisker| whisker.name == name.value);
    let mut fields = Fields::of(reader, &entry.value, "a whisker", name.span)?;
    let base = match reference {
        Some(_) => fields.entry(BASE.name),
        None => fields.required(BASE.name, BASE.example),
    };
    let base_body = match (base, reference) {
        (Some(entry), _) => reader.point(&entry.value, &BASE).map(|point| point.value),
        (None, reference) => reference.map(|whisker| whisker.base_body),
    };
    let direction_body = match reference {
        Some(whisker) => {
            let mut direction = whisker.direction_body;
            fields.set(reader, &DIRECTION, &mut direction);
            Some(direction)
        }
        None => fields.number(reader, &DIRECTION).map(|direction| direction.value),
    };
    let mut pitch = reference.map_or(0.0, |whisker| whisker.pitch);
    fields.set(reader, &PITCH, &mut pitch);
    // All whiskers of a preset have the same shaft and the same hinge.
    let usual = preset.first().cloned().map(|whisker| (whisker.shaft, whisker.hinge));
    let (usual_shaft, usual_hinge) = usual.unwrap_or_default();
    let shaft = shaft(reader, &mut fields, usual_shaft, name.span);
    let hinge = match fields.entry("hinge") {
        Some(entry) => hinge(reader, entry, usual_hinge),
        None => Some(usual_hinge),
    };
    let calibration = match fields.entry("calibration") {
        Some(entry) => calibration(reader, entry).map(Some),
        None => Some(None),
    };
    fields.finish(reader);
    Some(Whisker {
        name: name.value.clone(),
        base_body: base_body?,
        direction_body: direction_body?,
        pitch,
        shaft,
        hinge: hinge?,
        calibration: calibration?,
    })
}

/// Reads a calibration file.
fn calibration(reader: &mut Reader<'_>, entry: &Entry) -> Option<Calibration> {
    let path = reader.text(&entry.value)?;
    let found = reader.file(&path.value).and_then(|bytes| {
        let text = utf8(&bytes).map_err(|fault| format!("{fault}; {}", NotUtf8::ADVICE))?;
        read_calibration(text).map_err(|error| error.to_string())
    });
    found
        .map_err(|reason| {
            let fault = Diagnostic::error(fault::FILE, format!("cannot use `{}`", path.value), path.span, reason);
            reader.report(
                fault.hint("give the path of a file of `vibrissa calibrate`, relative to the folder of the scenario"),
            );
        })
        .ok()
}

/// Reads the keys of the shaft of a whisker, as differences from the `usual` one. The name of the whisker is at
/// `place`.
fn shaft(reader: &mut Reader<'_>, fields: &mut Fields<'_>, usual: Shaft, place: Span) -> Shaft {
    let fault_count = reader.fault_count();
    let mut shaft = usual;
    fields.set(reader, &LENGTH, &mut shaft.length);
    fields.set(reader, &RADIUS, &mut shaft.radius);
    let mut tip_radius = 0.0;
    let tip = fields.set(reader, &TIP_RADIUS, &mut tip_radius);
    shaft.tip_radius = tip.map(|_| tip_radius);
    fields.set(reader, &DENSITY, &mut shaft.density);
    fields.set(reader, &YOUNG_MODULUS, &mut shaft.young_modulus);
    fields.set(reader, &DAMPING, &mut shaft.damping);
    fields.set(reader, &OUT_OF_PLANE, &mut shaft.out_of_plane);
    if let Some(entry) = fields.entry("links")
        && let Some(links) = reader.count(&entry.value, "links", LINKS, 16)
    {
        shaft.links = links;
    }
    if reader.fault_count() == fault_count {
        match tip {
            Some(tip) if tip_radius > shaft.radius => reader.report(thick_tip(&shaft, tip_radius, tip)),
            // Without inertia, a shaft may be as light as that of an animal.
            _ if reader.is_quasi_static => {}
            _ => check_inertia(reader, &shaft, place),
        }
    }
    shaft
}

/// The diagnostic for a tip that is thicker than the base.
fn thick_tip(shaft: &Shaft, tip_radius: f64, place: Span) -> Diagnostic {
    let millimetres = |radius| format_si(radius, Dimension::LENGTH);
    let label = format!("at the base the radius is {}", millimetres(shaft.radius));
    let message = format!("the shaft is thicker at the tip: {}", millimetres(tip_radius));
    Diagnostic::error(fault::RIG, message, place, label)
        .hint("set `tip_radius` to at most `radius`; without it, the shaft has one radius")
}

/// Checks that the moment of inertia of the last and lightest link is large enough for the simulator. Its mass is then
/// large enough as well, because no link is longer than 250 mm.
fn check_inertia(reader: &mut Reader<'_>, shaft: &Shaft, place: Span) {
    let inertia = link_inertia(shaft, shaft.links - 1);
    if inertia >= MIN_INERTIA {
        return;
    }
    let kilogram_metres = |moment| format_si(moment, Dimension::INERTIA);
    let label = format!(
        "a link has a moment of inertia of {} about its centre, and needs {}",
        kilogram_metres(inertia),
        kilogram_metres(MIN_INERTIA)
    );
    let fault = Diagnostic::error(fault::RIG, "the links are too light to be simulated by MuJoCo", place, label);
    reader.report(fault.hint(
        "use fewer `links`, or a thicker, longer or denser shaft; or write `world: quasistatic`, a simulator without inertia",
    ));
}

/// Reads a hinge, as differences from the `usual` one.
fn hinge(reader: &mut Reader<'_>, entry: &Entry, usual: Hinge) -> Option<Hinge> {
    let mut fields = Fields::of(reader, &entry.value, "a hinge", entry.key.span)?;
    let mut hinge = usual;
    fields.set(reader, &HINGE_STIFFNESS, &mut hinge.stiffness);
    fields.set(reader, &HINGE_DAMPING, &mut hinge.damping);
    fields.set(reader, &HINGE_ARMATURE, &mut hinge.armature);
    fields.finish(reader);
    Some(hinge)
}
