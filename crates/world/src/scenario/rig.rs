//! Reader of `rig`, with the checks that concern its simulation.

use super::fault;
use super::reader::Reader;
use super::{Files, timing};
use crate::physics::{MIN_INERTIA, Physics, light_shaft};
use vibrissa_runtime::rig::{Rig, Whisker};
use vibrissa_runtime::units::{Dimension, format_si};
use vibrissa_text::diagnostic::{Diagnostic, Source, Span};
use vibrissa_yaml::{Entry, Node, Placed, parse, rig, root_place};

/// Reads a text that has a rig alone: the keys of `rig` in a scenario, or the key `rig` with them.
///
/// # Errors
/// As for [`read`](super::read).
pub fn read_rig(source: &Source, files: &mut Files<'_>) -> Result<Rig, Vec<Diagnostic>> {
    let (tree, faults) = parse(source, "rig")?;
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
    // Without inertia, a shaft may be as light as that of an animal.
    let unchecked = |_: &mut vibrissa_yaml::Reader<'_>, _: &Whisker, _: Span| {};
    let check = if reader.is_mujoco { check_inertia } else { unchecked };
    let simulated = rig::Use { applies: |_| true, check };
    let rig::ReadRig { rig, mut physics, places } = rig::read(reader, node, place, simulated)?;
    timing::fit(reader, rig.sensing.sample_rate, &mut physics, &places);
    (reader.fault_count() == fault_count).then_some((rig, physics))
}

/// Checks that the simulator's least moment of inertia does not change the dynamics of the whisker.
fn check_inertia(reader: &mut vibrissa_yaml::Reader<'_>, whisker: &Whisker, place: Span) {
    let Some(share) = light_shaft(&whisker.shaft) else { return };
    let least = format_si(MIN_INERTIA, Dimension::INERTIA);
    let label =
        format!("a link has at least {least} there, which adds {:.0} % to the whisker's inertia", 100.0 * share);
    let fault = Diagnostic::error(fault::RIG, "the links are too light to be simulated by MuJoCo", place, label);
    reader.report(fault.hint(
        "use fewer `links`, or a thicker, longer or denser shaft; or write `world: quasistatic`, a simulator without inertia",
    ));
}
