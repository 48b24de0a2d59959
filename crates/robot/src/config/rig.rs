//! The section `rig`, which has the keys of a scenario.

use vibrissa_runtime::rig::Rig;
use vibrissa_text::diagnostic::{Diagnostic, Source};
use vibrissa_yaml::{Files, Node, Placed, Reader, rig};

/// Reads the rig of a configuration. Without the section, it is the reference rig.
pub(super) fn read(source: &Source, tree: &Placed<Node>, files: &mut Files<'_>) -> Result<Rig, Vec<Diagnostic>> {
    let Some(entry) = tree.entry("rig") else { return Ok(Rig::default()) };
    let mut reader = Reader::new(source, files, Vec::new());
    let on_robot = rig::Use { applies: |key| key.is_on_robot, check: |_, _, _| {} };
    let rig = rig::read(&mut reader, &entry.value, entry.key.span, on_robot);
    reader.finish(rig.map(|read| read.rig))
}
