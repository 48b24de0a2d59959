//! Changes of a scenario by a sweep.

use super::reader::Reader;
use super::{fault, scene};
use crate::scenario::Files;
use crate::scene::Scene;
use std::ops::Range;
use vibrissa_text::diagnostic::{Diagnostic, Source, Span};
use vibrissa_yaml::{Entry, Node, Placed, parse, written};

/// One value for a key of a scenario, such as `rig.physics.friction`.
#[derive(Debug, Clone)]
pub struct Change {
    path: Placed<String>,
    value: Placed<Node>,
}

impl Change {
    /// Creates a change of the key or item at the end of `path` to `value`. The path consists of keys separated by points,
    /// and of numbers of list items in brackets: `objects[0].circle.radius`.
    #[must_use]
    pub fn new(path: Placed<String>, value: Placed<Node>) -> Self {
        Self { path, value }
    }

    /// The value in canonical notation.
    #[must_use]
    pub fn text(&self) -> String {
        flow(&self.value.value)
    }

    /// Inserts the value into the tree of a scenario. Spans of the change are moved by `offset` bytes.
    fn apply(&self, reader: &mut Reader<'_>, tree: &mut Placed<Node>, offset: usize) {
        let start = self.path.span.start + offset;
        let mut node = tree;
        for Step { kind, text, range } in steps(&self.path.value) {
            let span = Span::new(start + range.start, start + range.end);
            let found = match kind {
                StepKind::Key => key(&mut node.value, text, span),
                StepKind::Item => item(&mut node.value, text),
            };
            match found {
                Ok(found) => node = found,
                Err((code, label, hint)) => {
                    let outer = self.path.value.get(..range.start).unwrap_or_default().trim_end_matches(['.', '[']);
                    let message = if outer.is_empty() {
                        "the scenario has no keys".to_owned()
                    } else {
                        format!("`{outer}` has no {} `{text}` that can be varied", kind.name())
                    };
                    reader.report(Diagnostic::error(code, message, span, label).hint(hint));
                    return;
                }
            }
        }
        *node = self.value.clone().moved(offset);
    }
}

/// A step of a path.
struct Step<'p> {
    kind: StepKind,
    /// The key, or the number of the item.
    text: &'p str,
    /// Its bytes in the path.
    range: Range<usize>,
}

#[derive(Clone, Copy)]
enum StepKind {
    /// A key of a mapping.
    Key,
    /// An item of a list: `[0]`.
    Item,
}

impl StepKind {
    fn name(self) -> &'static str {
        match self {
            Self::Key => "key",
            Self::Item => "item",
        }
    }
}

/// The steps of a path such as `objects[0].circle.radius`.
fn steps(path: &str) -> impl Iterator<Item = Step<'_>> {
    let mut start = 0_usize;
    path.split_inclusive(['.', '[']).map(move |part| {
        let before = start.checked_sub(1).and_then(|before| path.as_bytes().get(before));
        let kind = if before == Some(&b'[') { StepKind::Item } else { StepKind::Key };
        let text = part.trim_end_matches(['.', '[']);
        let text = if matches!(kind, StepKind::Item) { text.strip_suffix(']').unwrap_or("") } else { text };
        let range = start..start + text.len();
        start += part.len();
        Step { kind, text, range }
    })
}

/// The reason why a step leads nowhere: code, label, hint.
type Astray = (&'static str, String, String);

/// The value of a key. A key that does not exist is added.
fn key<'n>(node: &'n mut Node, name: &str, span: Span) -> Result<&'n mut Placed<Node>, Astray> {
    let kind = node.kind();
    let Node::Mapping(entries) = node else {
        let hint = match node {
            Node::List(_) => "name an item by its number, such as `objects[0]`",
            _ => "vary the value itself: list its values",
        };
        return Err((fault::UNKNOWN_KEY, format!("it is {kind} in the scenario"), hint.to_owned()));
    };
    let key = Placed { value: name.to_owned(), span };
    let position = entries.iter().position(|entry| entry.key.value == name).unwrap_or_else(|| {
        let value = Placed { value: Node::Mapping(Vec::new()), span };
        entries.push(Entry { key: key.clone(), value });
        entries.len() - 1
    });
    let entry = &mut entries[position];
    entry.key = key;
    Ok(&mut entry.value)
}

/// The item of a list. Items are counted from 0.
fn item<'n>(node: &'n mut Node, number: &str) -> Result<&'n mut Placed<Node>, Astray> {
    let kind = node.kind();
    let Node::List(items) = node else {
        let hint = "write a point before a key, such as `rig.physics`".to_owned();
        return Err((fault::UNKNOWN_KEY, format!("it is {kind} in the scenario"), hint));
    };
    let count = items.len();
    let hint = match count {
        0 => "the list is empty".to_owned(),
        1 => "the list has one item, `[0]`".to_owned(),
        _ => format!("the list has the items `[0]` to `[{}]`", count - 1),
    };
    let found = number.parse().ok().and_then(|number: usize| items.get_mut(number));
    found.ok_or_else(|| (fault::UNKNOWN_KEY, "no such item".to_owned(), hint))
}

/// Reads the scenario `source` with the changes of a `sweep`. The source of the diagnostics contains both texts.
///
/// # Errors
/// The text with the change, and all errors in it.
pub fn read(
    source: &Source,
    sweep: &Source,
    changes: &[&Change],
    files: &mut Files<'_>,
) -> Result<Scene, (Box<Source>, Vec<Diagnostic>)> {
    let in_scenario = |faults| (Box::new(source.clone()), faults);
    if changes.is_empty() {
        return scene::read(source, files).map_err(in_scenario);
    }
    let (mut tree, faults) = parse(source, "scenario").map_err(in_scenario)?;
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
pub(super) fn flow(node: &Node) -> String {
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
#[must_use]
pub fn quoted(text: &str) -> String {
    let is_plain = |letter: char| letter.is_alphanumeric() || " ._-+/^%".contains(letter);
    if text.chars().all(is_plain) { text.to_owned() } else { format!("{text:?}") }
}
