//! The policy of a scenario.

use super::parameter::parameter;
use super::reader::Reader;
use super::{fault, file};
use crate::scene::{PolicyReference, PolicySetting};
use vibrissa_text::diagnostic::{Diagnostic, Span};
use vibrissa_yaml::{Fields, Node, Placed};

const EXAMPLE: &str = "{file: ../policies/vibrissa.fsm, set: {speed: 80 mm/s}}";

/// Reads a policy: its path, or its path with values of parameters.
pub(super) fn read(reader: &mut Reader<'_>, node: &Placed<Node>) -> Option<PolicyReference> {
    if !matches!(node.value, Node::Mapping(_)) {
        return file::reference(reader, node).map(|file| PolicyReference { file, settings: Vec::new() });
    }
    let mut fields = Fields::of(reader, node, "a policy", node.span)?;
    let file = fields.required("file", EXAMPLE).and_then(|entry| file::reference(reader, &entry.value));
    let settings = match fields.entry("set") {
        Some(entry) => settings(reader, &entry.value),
        None => Some(Vec::new()),
    };
    fields.finish(reader);
    Some(PolicyReference { file: file?, settings: settings? })
}

fn settings(reader: &mut Reader<'_>, node: &Placed<Node>) -> Option<Vec<PolicySetting>> {
    let Node::Mapping(entries) = &node.value else {
        reader.wrong_type(node, "a mapping", format!("write every parameter with its value, `{EXAMPLE}`"));
        return None;
    };
    let settings = entries.iter().map(|entry| {
        let (value, _) = parameter(reader, &entry.value)?;
        Some(PolicySetting { name: entry.key.value.clone(), value, span: entry.key.span })
    });
    settings.collect::<Vec<_>>().into_iter().collect()
}

/// The diagnostic for a parameter that the policy of the scenario cannot have.
#[must_use]
pub fn unfit(place: Span, reason: &str) -> Diagnostic {
    Diagnostic::error(fault::UNFIT, "the policy does not fit the scenario", place, reason)
        .hint("`set` has parameters of the policy, as `--set` does")
}
