//! From a tree with drawn names to that of one scene.

use std::collections::BTreeSet;

use super::super::fault;
use super::super::reader::Reader;
use super::{Distribution, drawn_name, take, unknown};
use vibrissa_runtime::units::parse_quantity;
use vibrissa_text::diagnostic::{Diagnostic, Span};
use vibrissa_yaml::{Entry, Node, Placed, fault::TOO_LARGE};

/// The most copies of one item.
const MOST_COPIES: i128 = 100;

/// The section `draw`, in the order of the text.
#[derive(Debug, Clone, Default)]
pub(super) struct Draws(Vec<(Placed<String>, Distribution)>);

impl Draws {
    /// Reads a section `draw`.
    pub(super) fn read(reader: &mut Reader<'_>, node: &Placed<Node>) -> Option<Self> {
        let Node::Mapping(entries) = &node.value else {
            reader.wrong_type(node, "names with ranges", "for example `draw: {radius: 30 .. 120 mm}`");
            return None;
        };
        let mut draws = Vec::new();
        for Entry { key, value } in entries {
            match Distribution::of(&key.value, value) {
                Ok(distribution) => draws.push((key.clone(), distribution)),
                Err(fault) => reader.report(*fault),
            }
        }
        (draws.len() == entries.len()).then_some(Self(draws))
    }
}

/// Names with the values that were drawn for them, the innermost last.
type Drawn = Vec<(String, Placed<Node>)>;

/// The tree of a scene with the values that `share` draws.
///
/// # Errors
/// A name that is not drawn, or what cannot be drawn.
pub(super) fn resolve(
    tree: &Placed<Node>,
    draws: &Draws,
    share: &mut dyn FnMut() -> f64,
) -> Result<Placed<Node>, Box<Diagnostic>> {
    let mut drawn = Drawn::new();
    add(draws, &mut drawn, share)?;
    value(tree, &mut drawn, share)
}

/// Draws the values of a section. A value can contain those before it.
fn add(draws: &Draws, drawn: &mut Drawn, share: &mut dyn FnMut() -> f64) -> Result<(), Box<Diagnostic>> {
    for (name, distribution) in &draws.0 {
        let chosen = Placed { value: distribution.at(share()), span: name.span };
        let chosen = value(&chosen, drawn, share)?;
        drawn.push((name.value.clone(), chosen));
    }
    Ok(())
}

fn value(
    node: &Placed<Node>,
    drawn: &mut Drawn,
    share: &mut dyn FnMut() -> f64,
) -> Result<Placed<Node>, Box<Diagnostic>> {
    let span = node.span;
    let resolved = match &node.value {
        Node::Text(text) => match drawn_name(text) {
            Some((name, is_negative)) => named(name, is_negative, span, drawn)?,
            None => node.value.clone(),
        },
        Node::List(items) => {
            let mut resolved = Vec::new();
            for item in items {
                repeated(item, &mut resolved, drawn, share)?;
            }
            Node::List(resolved)
        }
        Node::Mapping(entries) => {
            let entry =
                |Entry { key, value: of }: &Entry| Ok(Entry { key: key.clone(), value: value(of, drawn, share)? });
            Node::Mapping(entries.iter().map(entry).collect::<Result<_, Box<Diagnostic>>>()?)
        }
        other => other.clone(),
    };
    Ok(Placed { value: resolved, span })
}

/// What was drawn for a name.
fn named(name: &str, is_negative: bool, span: Span, drawn: &Drawn) -> Result<Node, Box<Diagnostic>> {
    let Some((_, found)) = drawn.iter().rev().find(|(known, _)| known == name) else {
        let known: Vec<_> = drawn.iter().map(|(name, _)| name.as_str()).collect();
        return Err(Box::new(unknown(name, span, &known)));
    };
    match &found.value {
        value if !is_negative => Ok(value.clone()),
        Node::Integer(number) => Ok(Node::Integer(-number)),
        Node::Float(number) => Ok(Node::Float(-number)),
        Node::Text(text) if parse_quantity(text).is_ok() => {
            Ok(Node::Text(text.strip_prefix('-').map_or_else(|| format!("-{text}"), str::to_owned)))
        }
        other => {
            let message = format!("`-${name}` is not a number, because `{name}` is {}", other.kind());
            let fault = Diagnostic::error(fault::TYPE, message, span, "has no negative");
            Err(Box::new(fault.hint("leave out the sign")))
        }
    }
}

/// Adds the copies of an item of a list. Each draws the values of the item's own section anew.
fn repeated(
    item: &Placed<Node>,
    copies: &mut Vec<Placed<Node>>,
    drawn: &mut Drawn,
    share: &mut dyn FnMut() -> f64,
) -> Result<(), Box<Diagnostic>> {
    let mut body = item.clone();
    let count = match take(&mut body, "repeat") {
        Some(repeat) => count(&value(&repeat.value, drawn, share)?, share)?,
        None => 1,
    };
    let section = take(&mut body, "draw").map(|section| section.value);
    for _ in 0..count {
        let outer = drawn.len();
        if let Some(section) = &section {
            add(&own_draws(section)?, drawn, share)?;
        }
        let resolved = value(&body, drawn, share);
        drawn.truncate(outer);
        copies.push(resolved?);
    }
    Ok(())
}

/// The number of copies: an integer, or a range of integers.
fn count(node: &Placed<Node>, share: &mut dyn FnMut() -> f64) -> Result<i128, Box<Diagnostic>> {
    let drawn = match &node.value {
        Node::Text(_) => Distribution::of("repeat", node)?.at(share()),
        other => other.clone(),
    };
    if let Node::Integer(count @ 0..=MOST_COPIES) = drawn {
        return Ok(count);
    }
    let message = format!("an item is repeated 0 to {MOST_COPIES} times");
    let fault = Diagnostic::error(TOO_LARGE, message, node.span, "must be such a number, or a range of them");
    Err(Box::new(fault.hint("for example `repeat: 2 .. 5`")))
}

/// The section `draw` of an item.
fn own_draws(section: &Placed<Node>) -> Result<Draws, Box<Diagnostic>> {
    let Node::Mapping(entries) = &section.value else {
        let message = "the section `draw` has names with ranges";
        let fault = Diagnostic::error(fault::TYPE, message, section.span, "must be a mapping");
        return Err(Box::new(fault.hint("for example `draw: {radius: 30 .. 120 mm}`")));
    };
    let read = |Entry { key, value }: &Entry| Ok((key.clone(), Distribution::of(&key.value, value)?));
    Ok(Draws(entries.iter().map(read).collect::<Result<_, Box<Diagnostic>>>()?))
}

/// Reports what is drawn and never used, which is often a misspelt name.
pub(super) fn check_uses(reader: &mut Reader<'_>, tree: &Placed<Node>, draws: &Draws) {
    let mut used = BTreeSet::new();
    add_uses(&tree.value, &mut used);
    for (_, distribution) in &draws.0 {
        if let Distribution::OneOf(items) = distribution {
            for item in items {
                add_uses(&item.value, &mut used);
            }
        }
    }
    for (name, _) in draws.0.iter().filter(|(name, _)| !used.contains(name.value.as_str())) {
        let message = format!("`{}` is drawn, and nothing uses it", name.value);
        let fault = Diagnostic::error(fault::NAME, message, name.span, "is not used");
        reader.report(fault.hint(format!("write `${}` in place of a value, or remove it", name.value)));
    }
}

fn add_uses<'n>(node: &'n Node, used: &mut BTreeSet<&'n str>) {
    match node {
        Node::Text(text) => used.extend(drawn_name(text).map(|(name, _)| name)),
        Node::List(items) => items.iter().for_each(|item| add_uses(&item.value, used)),
        Node::Mapping(entries) => entries.iter().for_each(|entry| add_uses(&entry.value.value, used)),
        _ => {}
    }
}
