//! Reader of a rig: the differences from a predefined one. The table of its keys is [`KEYS`](vibrissa_declare::rig::KEYS).

mod check;
mod part;
mod value;
mod whiskers;

use vibrissa_declare::physics::{Physics, Preset};
use vibrissa_declare::rig::RigKey;
use vibrissa_runtime::rig::{Rig, Whisker};
use vibrissa_text::diagnostic::Span;

use crate::fields::Fields;
use crate::node::{Node, Placed};
use crate::reader::Reader;
use part::Reading;

/// A rig that was read.
#[derive(Debug, Clone)]
pub struct ReadRig {
    /// The rig.
    pub rig: Rig,
    /// The settings of the simulation.
    pub physics: Physics,
    /// The positions of its keys in the text.
    pub places: Places,
}

/// The positions of the keys that a text gives.
#[derive(Debug, Clone, Default)]
pub struct Places {
    /// Values by the paths of their keys, in the order of the text's sections.
    values: Vec<(&'static str, Span)>,
}

impl Places {
    /// The place of the first of these keys that is given.
    #[must_use]
    pub fn first(&self, paths: &[&str]) -> Option<Span> {
        let place = |path: &&str| self.values.iter().find(|(given, _)| given == path).map(|&(_, span)| span);
        paths.iter().find_map(place)
    }
}

/// What depends on the use of a rig.
#[derive(Clone, Copy)]
pub struct Use {
    /// True for the keys that have an effect. The others are only read.
    pub applies: fn(&RigKey) -> bool,
    /// A further check of every whisker without a fault. The span is that of its name.
    pub check: fn(&mut Reader<'_>, &Whisker, Span),
}

/// Reads a rig, which the span `place` represents, and checks its values together. Omitted keys have the values of the
/// preset, by default those of the reference rig.
pub fn read(reader: &mut Reader<'_>, node: &Placed<Node>, place: Span, rig_use: Use) -> Option<ReadRig> {
    let fault_count = reader.fault_count();
    let mut fields = Fields::of(reader, node, "a rig", place)?;
    let preset = fields.entry("preset").and_then(|entry| {
        let index = reader.choice(&entry.value, "a preset", &Preset::ALL.map(Preset::name));
        index.and_then(|index| Preset::ALL.get(index)).copied()
    });
    let (mut rig, mut physics) = preset.unwrap_or_default().rig();
    let mut reading = Reading { rig_use, places: Places::default() };
    if let Some(entry) = fields.entry("platform") {
        reading.section(reader, entry, "platform", &mut rig.platform);
    }
    if let Some(entry) = fields.entry("whiskers") {
        rig.whiskers = reading.whiskers(reader, entry, &rig.whiskers).unwrap_or_default();
    }
    if let Some(entry) = fields.entry("physics") {
        reading.section(reader, entry, "physics", &mut physics);
    }
    if let Some(entry) = fields.entry("sensing") {
        reading.section(reader, entry, "sensing", &mut rig.sensing);
    }
    fields.finish(reader);
    let places = reading.places;
    if reader.fault_count() == fault_count {
        check::check(reader, &rig, &places);
    }
    // An incomplete rig would cause misleading diagnostics in the checks of the whole text.
    (reader.fault_count() == fault_count).then_some(ReadRig { rig, physics, places })
}
