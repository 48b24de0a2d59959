//! Changes of a scenario by a sweep.

use super::node::{Entry, Node, Placed};
use super::reader::{Reader, written};
use super::{fault, scene};
use crate::diagnostic::{Diagnostic, Source, Span};
use crate::scenario::Files;
use crate::scene::Scene;

/// One value for a key of a scenario, such as `rig.physics.friction`.
#[derive(Debug, Clone)]
pub(crate) struct Change {
    path: Placed<String>,
    value: Placed<Node>,
}

impl Change {
    /// Creates a change of the key at the end of `path` to `value`. The path consists of keys separated by points.
    pub(crate) fn new(path: Placed<String>, value: Placed<Node>) -> Self {
        Self { path, value }
    }

    /// The value in canonical notation.
    pub(crate) fn text(&self) -> String {
        flow(&self.value.value)
    }

    /// Inserts the value into the tree of a scenario. Spans of the change are moved by `offset` bytes.
    fn apply(&self, reader: &mut Reader<'_>, tree: &mut Placed<Node>, offset: usize) {
        let start = self.path.span.start + offset;
        let (mut node, mut behind) = (tree, 0);
        let words: Vec<&str> = self.path.value.split('.').collect();
        for (index, &word) in words.iter().enumerate() {
            let key = Placed { value: word.to_owned(), span: Span::new(start + behind, start + behind + word.len()) };
            behind += word.len() + 1;
            let kind = node.value.kind();
            let Node::Mapping(entries) = &mut node.value else {
                let message = format!("`{}` has no keys that can be varied", words[..index].join("."));
                let label = format!("it is {kind} in the scenario");
                let fault = Diagnostic::error(fault::UNKNOWN_KEY, message, key.span, label);
                reader.report(fault.hint("vary the value itself: list its values"));
                return;
            };
            let position = entries.iter().position(|entry| entry.key.value == word).unwrap_or_else(|| {
                let value = Placed { value: Node::Mapping(Vec::new()), span: key.span };
                entries.push(Entry { key: key.clone(), value });
                entries.len() - 1
            });
            entries[position].key = key;
            node = &mut entries[position].value;
        }
        *node = self.value.clone().moved(offset);
    }
}

/// Reads the scenario `source` with the changes of a `sweep`. The source of the diagnostics contains both texts.
pub(crate) fn read(
    source: &Source,
    sweep: &Source,
    changes: &[&Change],
    files: &mut Files<'_>,
) -> Result<Scene, (Box<Source>, Vec<Diagnostic>)> {
    let in_scenario = |faults| (Box::new(source.clone()), faults);
    if changes.is_empty() {
        return scene::read(source, files).map_err(in_scenario);
    }
    let (mut tree, faults) = fault::parse(source, "scenario").map_err(in_scenario)?;
    let mut both = source.clone();
    both.add(&sweep.name, Ok(&sweep.text));
    let offset = both.part_span(1).start;
    let mut reader = Reader::new(&both, files, faults);
    for change in changes {
        change.apply(&mut reader, &mut tree, offset);
    }
    let scene = scene::read_scene(&mut reader, &tree);
    let scene = reader.finish(scene);
    scene.map_err(|faults| (Box::new(both), faults))
}

/// Writes a value on one line.
fn flow(node: &Node) -> String {
    match node {
        Node::List(items) => {
            format!("[{}]", items.iter().map(|item| flow(&item.value)).collect::<Vec<_>>().join(", "))
        }
        Node::Mapping(entries) => {
            let entries = entries.iter().map(|Entry { key, value }| format!("{}: {}", key.value, flow(&value.value)));
            format!("{{{}}}", entries.collect::<Vec<_>>().join(", "))
        }
        Node::Text(text) => quoted(text),
        scalar => written(scalar),
    }
}

/// Returns a text in quotes, if YAML would not read it as one word.
pub(crate) fn quoted(text: &str) -> String {
    let is_plain = |letter: char| letter.is_alphanumeric() || " ._-+/^%".contains(letter);
    if text.chars().all(is_plain) { text.to_owned() } else { format!("{text:?}") }
}
