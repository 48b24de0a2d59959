//! Reader of the whiskers by name.

use vibrissa_declare::rig::group;
use vibrissa_runtime::rig::Whisker;
use vibrissa_runtime::signal::MAX_WHISKERS;
use vibrissa_text::diagnostic::Diagnostic;

use super::part::Reading;
use crate::fault;
use crate::fields::Fields;
use crate::node::{Entry, Node};
use crate::reader::Reader;

/// The mapping of a whisker's keys.
const PATH: &str = "whiskers.*";
/// What a whisker with a new name must have.
const NEEDED: [&str; 2] = ["base", "direction"];

impl Reading {
    /// Reads the whiskers. Omitted keys have the values of the whisker with the same name in the `preset` rig. A whisker
    /// with a new name requires a position and a direction.
    pub(super) fn whiskers(
        &mut self,
        reader: &mut Reader<'_>,
        entry: &Entry,
        preset: &[Whisker],
    ) -> Option<Vec<Whisker>> {
        let entries = match &entry.value.value {
            Node::Mapping(entries) if !entries.is_empty() => entries,
            Node::Mapping(_) => {
                let fault = Diagnostic::error(fault::RIG, "the rig has no whisker", entry.key.span, "empty");
                reader.report(
                    fault.hint("add a whisker, such as `r0: {}`, or leave `whiskers` out for the reference pair"),
                );
                return None;
            }
            _ => {
                let hint = "write each whisker under its name, such as `r0: {length: 75 mm}`";
                reader.wrong_type(&entry.value, "a mapping", hint);
                return None;
            }
        };
        if let Some(extra) = entries.get(MAX_WHISKERS) {
            let message = format!("a rig can have {MAX_WHISKERS} whiskers at most");
            let fault = Diagnostic::error(fault::RIG, message, extra.key.span, "one too many");
            reader.report(fault.hint("leave some out"));
            return None;
        }
        let whiskers: Vec<_> = entries.iter().map(|entry| self.whisker(reader, entry, preset)).collect();
        whiskers.into_iter().collect()
    }

    fn whisker(&mut self, reader: &mut Reader<'_>, entry: &Entry, preset: &[Whisker]) -> Option<Whisker> {
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
        // All whiskers of a preset have the same shaft and the same hinge.
        let usual = preset.first().map(|whisker| (whisker.shaft.clone(), whisker.hinge.clone()));
        let (shaft, hinge) = usual.unwrap_or_default();
        let unfitted = || Whisker { shaft, hinge, ..Whisker::unfitted() };
        let mut whisker = Whisker { name: name.value.clone(), ..reference.cloned().unwrap_or_else(unfitted) };
        let needed: &[&str] = if reference.is_some() { &[] } else { &NEEDED };

        let fault_count = reader.fault_count();
        let mut fields = Fields::of(reader, &entry.value, group(PATH), name.span)?;
        self.keys(reader, &mut fields, PATH, needed, &mut whisker);
        fields.former("shaft", "write its keys without it, such as `r0: {length: 75 mm, radius: 0.125 mm}`");
        fields.finish(reader);
        let tip = self.places.values.iter().rev().find(|(path, _)| *path == "whiskers.*.tip_radius");
        if reader.fault_count() == fault_count {
            super::check::tip(reader, &whisker.shaft, tip.map(|&(_, span)| span));
        }
        if reader.fault_count() == fault_count {
            (self.rig_use.check)(reader, &whisker, name.span);
        }
        Some(whisker)
    }
}
