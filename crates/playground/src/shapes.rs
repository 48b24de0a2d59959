//! The objects of a scenario's text, and changes of that text by which a page moves, adds and removes them.
//!
//! A change replaces the numbers that it concerns, and nothing else of the text. What the scenario then is, its reader decides.

use serde::{Deserialize, Serialize};
use vibrissa_runtime::units::{Dimension, parse_quantity};
use vibrissa_text::diagnostic::{Source, Span};
use vibrissa_yaml::{Node, Placed, parse};

/// The paths of the points of an object, by which it is moved. Every object has at most one of them.
const ANCHORS: [&str; 4] = ["centre", "corner", "start.position", "frame.position"];
/// The path of the corners of a polygon.
const VERTICES: &str = "vertices";
/// The path of the radius of a disk.
const RADIUS: &str = "radius";
/// The number of written steps of length in a metre, so that the resolution is a tenth of a millimetre.
const STEPS: f64 = 1e4;

/// An object of a scenario.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct Shape {
    /// The key of its kind, such as `circle`.
    pub(crate) kind: String,
    /// The points (m) that can be moved: the corners of a polygon, otherwise the one that moves the object. Empty if its text has none.
    pub(crate) points: Vec<[f64; 2]>,
    /// The radius (m) of a disk.
    pub(crate) radius: Option<f64>,
}

/// A change of an object.
#[derive(Debug, Clone, Deserialize)]
#[serde(tag = "what", rename_all = "snake_case", deny_unknown_fields)]
pub(crate) enum Change {
    /// Moves a point of an object.
    Move {
        /// The index of the object.
        object: usize,
        /// The index of the point.
        point: usize,
        /// The new position (m).
        to: [f64; 2],
    },
    /// Changes the radius of a disk.
    Resize {
        /// The index of the object.
        object: usize,
        /// The new radius (m).
        radius: f64,
    },
    /// Removes an object.
    Remove {
        /// The index of the object.
        object: usize,
    },
    /// Adds a disk before the other objects.
    Disk {
        /// Its centre (m).
        centre: [f64; 2],
        /// Its radius (m).
        radius: f64,
    },
    /// Adds a polygon before the other objects.
    Polygon {
        /// Its corners (m) in their order.
        corners: Vec<[f64; 2]>,
    },
}

/// The objects of a scenario, in the order of its text.
///
/// # Errors
/// If the text is no YAML, or has no list of objects.
pub(crate) fn shapes(scenario: &str) -> Result<Vec<Shape>, String> {
    let tree = tree(scenario)?;
    Ok(objects(&tree)?.iter().map(shape).collect())
}

/// The text of the scenario with the change.
///
/// # Errors
/// If the text does not have what is to be changed, in words.
pub(crate) fn changed(scenario: &str, change: &Change) -> Result<String, String> {
    let tree = tree(scenario)?;
    let objects = objects(&tree)?;
    let of = |object: usize| objects.get(object).ok_or_else(|| format!("there is no object {object}"));
    match change {
        Change::Move { object, point, to } => {
            let node = points(of(*object)?).into_iter().nth(*point).ok_or("the object has no such point")?;
            let Some([x, y]) = pair(node) else { return Err("the point is not written as two lengths".to_owned()) };
            // From behind, so that the first span is still that of the text.
            let text = replaced(scenario, y.span, &length(to[1]));
            Ok(replaced(&text, x.span, &length(to[0])))
        }
        Change::Resize { object, radius } => {
            let radius_now =
                properties(of(*object)?).map(|(_, value)| value.find(RADIUS)).filter(|node| is_length(node));
            let node = radius_now.ok_or("the object has no radius")?;
            Ok(replaced(scenario, node.span, &length(radius.max(STEPS.recip()))))
        }
        Change::Remove { object } => remove(scenario, objects, *object),
        Change::Disk { centre, radius } => {
            let text = format!("circle: {{centre: {}, radius: {}}}", point(*centre), length(radius.max(STEPS.recip())));
            add(scenario, objects, &text)
        }
        Change::Polygon { corners } => {
            let corners: Vec<String> = corners.iter().map(|&corner| point(corner)).collect();
            add(scenario, objects, &format!("polygon: {{vertices: [{}]}}", corners.join(", ")))
        }
    }
}

fn tree(scenario: &str) -> Result<Placed<Node>, String> {
    let parsed = parse(&Source::new("scenario.yaml", scenario), "scenario");
    parsed
        .map(|(tree, _)| tree)
        .map_err(|faults| faults.first().map_or_else(String::new, |fault| fault.message.clone()))
}

fn objects(tree: &Placed<Node>) -> Result<&[Placed<Node>], String> {
    match tree.entry("objects").map(|entry| &entry.value.value) {
        Some(Node::List(items)) => Ok(items),
        _ => Err("the scenario has no list `objects`".to_owned()),
    }
}

/// The kind of an object, and the mapping of its properties.
fn properties(object: &Placed<Node>) -> Option<(&str, &Placed<Node>)> {
    let Node::Mapping(entries) = &object.value else { return None };
    let kind = entries.iter().find(|entry| entry.key.value != "texture")?;
    Some((&kind.key.value, &kind.value))
}

fn shape(object: &Placed<Node>) -> Shape {
    let (kind, value) = properties(object).map_or(("", None), |(kind, value)| (kind, Some(value)));
    let radius = value.filter(|_| kind == "circle").and_then(|value| metres(value.find(RADIUS)));
    let points = points(object).into_iter().filter_map(|node| {
        let [x, y] = pair(node)?;
        Some([metres(x)?, metres(y)?])
    });
    Shape { kind: kind.to_owned(), points: points.collect(), radius }
}

/// The nodes of the points of an object. All of them are pairs of lengths.
fn points(object: &Placed<Node>) -> Vec<&Placed<Node>> {
    let Some((_, value)) = properties(object) else { return Vec::new() };
    if let Some(entry) = value.entry(VERTICES)
        && let Node::List(vertices) = &entry.value.value
    {
        let corners: Vec<_> = vertices.iter().filter(|vertex| pair(vertex).is_some()).collect();
        return if corners.len() == vertices.len() { corners } else { Vec::new() };
    }
    let anchor = ANCHORS.iter().map(|path| value.find(path)).find(|node| pair(node).is_some());
    anchor.into_iter().collect()
}

fn pair(node: &Placed<Node>) -> Option<[&Placed<Node>; 2]> {
    let Node::List(items) = &node.value else { return None };
    let [x, y] = items.as_slice() else { return None };
    (is_length(x) && is_length(y)).then_some([x, y])
}

fn is_length(node: &Placed<Node>) -> bool {
    metres(node).is_some()
}

/// A length in metres.
fn metres(node: &Placed<Node>) -> Option<f64> {
    let Node::Text(text) = &node.value else { return None };
    let quantity = parse_quantity(text).ok()?;
    (quantity.dimension == Dimension::LENGTH).then_some(quantity.value_si)
}

/// A length (m) as text. Not a number is 0, which the reader of the scenario judges.
fn length(metres: f64) -> String {
    let steps = (metres * STEPS).round();
    format!("{} mm", if steps.is_finite() { steps / (STEPS / 1e3) } else { 0.0 })
}

fn point([x, y]: [f64; 2]) -> String {
    format!("[{}, {}]", length(x), length(y))
}

fn replaced(text: &str, span: Span, by: &str) -> String {
    let (before, behind) = (text.get(..span.start).unwrap_or_default(), text.get(span.end..).unwrap_or_default());
    format!("{before}{by}{behind}")
}

/// The line (bytes) on which a byte is, without its line break, and the indentation of an item `- …` that begins there. `None` if
/// something else is before it.
fn item_line(text: &str, start: usize) -> Option<(usize, &str)> {
    let line = text.get(..start)?.rfind('\n').map_or(0, |at| at + 1);
    let before = text.get(line..start)?;
    let indentation = before.trim_end().strip_suffix('-')?;
    indentation.chars().all(|letter| letter == ' ').then_some((line, indentation))
}

/// Adds an object before the first one.
fn add(text: &str, objects: &[Placed<Node>], object: &str) -> Result<String, String> {
    let first = objects.first().ok_or("the list `objects` is empty; write its first object as text")?.span.start;
    let place = Span::new(first, first);
    if let Some((line, indentation)) = item_line(text, first) {
        return Ok(replaced(text, Span::new(line, line), &format!("{indentation}- {object}\n")));
    }
    Ok(replaced(text, place, &format!("{{{object}}}, ")))
}

/// Removes an object with its lines. Comments before the next object stay.
fn remove(text: &str, objects: &[Placed<Node>], index: usize) -> Result<String, String> {
    let object = objects.get(index).ok_or_else(|| format!("there is no object {index}"))?;
    if objects.len() == 1 {
        return Err("a scenario has at least one object".to_owned());
    }
    let (line, indentation) = item_line(text, object.span.start)
        .ok_or("the objects are written on one line; remove this one from the text of the scenario")?;
    // The object ends before the first line that is indented as its own or less.
    let mut end = line;
    for (number, next) in text.get(line..).unwrap_or_default().split_inclusive('\n').enumerate() {
        let depth = next.len() - next.trim_start_matches(' ').len();
        if number > 0 && !next.trim().is_empty() && depth <= indentation.len() {
            break;
        }
        end += next.len();
    }
    Ok(replaced(text, Span::new(line, end), ""))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]
    use super::*;
    use proptest::prelude::*;
    use vibrissa_lab::built_in::NAMED_SCENARIOS;
    use vibrissa_world::scenario;

    const TWO: &str = "objects:\n  # The first one.\n  - circle: {centre: [40 cm, 0.4 m], radius: 30 cm}  # round\n  \
                       # The second one.\n  - polygon:\n      vertices:\n        - [1 m, 0 m]\n        - [2 m, 0 m]\n        \
                       - [2 m, 1 m]\nstart: {position: [0 m, 72 mm], heading: 90 deg}\n";

    fn near(found: [f64; 2], expected: [f64; 2]) -> bool {
        found.iter().zip(expected).all(|(found, expected)| (found - expected).abs() <= 0.51 / STEPS)
    }

    proptest! {
        #[test]
        fn a_moved_point_is_where_it_was_moved_to_and_all_else_stays(
            object in 0..2_usize, point in 0..3_usize, to in [-9.0..9.0_f64, -9.0..9.0_f64],
        ) {
            let before = shapes(TWO).unwrap();
            let moved = changed(TWO, &Change::Move { object, point, to });
            prop_assert_eq!(moved.is_ok(), point < before[object].points.len());
            if let Ok(text) = moved {
                let mut after = shapes(&text).unwrap();
                prop_assert!(near(after[object].points[point], to));
                after[object].points[point] = before[object].points[point];
                prop_assert_eq!(after, before);
                prop_assert_eq!(text.matches('#').count(), TWO.matches('#').count());
            }
        }

        #[test]
        fn an_added_object_is_removed_without_a_trace(
            centre in [-9.0..9.0_f64, -9.0..9.0_f64], radius in 0.001..9.0_f64, name in prop::sample::select(NAMED_SCENARIOS),
        ) {
            let text = changed(name.text, &Change::Disk { centre, radius }).unwrap();
            let added = shapes(&text).unwrap();
            prop_assert!(near(added[0].points[0], centre) && near([added[0].radius.unwrap(), 0.0], [radius, 0.0]));
            prop_assert_eq!(&added[1..], shapes(name.text).unwrap());
            prop_assert_eq!(changed(&text, &Change::Remove { object: 0 }).unwrap(), name.text);
        }

        #[test]
        fn no_text_and_no_change_is_a_panic(text in "(objects:\n)?[-\\[{}: a-c0-9#\n]{0,60}", object in 0..3_usize) {
            for change in [Change::Remove { object }, Change::Resize { object, radius: f64::NAN }, Change::Polygon { corners: Vec::new() }] {
                let _ = changed(&text, &change);
            }
        }
    }

    #[test]
    fn the_last_object_is_removed_with_its_lines_alone() {
        let text = changed(TWO, &Change::Remove { object: 1 }).unwrap();
        assert_eq!(shapes(&text).unwrap(), &shapes(TWO).unwrap()[..1]);
        assert!(text.contains("# The second one.\nstart:"), "{text}");
        assert!(changed(&text, &Change::Remove { object: 0 }).is_err());
    }

    #[test]
    fn an_object_is_added_to_a_list_in_brackets() {
        let text = "objects: [{circle: {centre: [1 m, 0 m], radius: 1 m}}]\n";
        let text = changed(text, &Change::Disk { centre: [3.0, 0.0], radius: 0.5 }).unwrap();
        assert_eq!(shapes(&text).unwrap().len(), 2, "{text}");
    }

    #[test]
    fn a_drawn_scene_is_a_scenario() {
        let name = NAMED_SCENARIOS[0];
        let corners = vec![[1.0, 0.0], [1.3, 0.0], [1.2, 0.4]];
        let text = changed(name.text, &Change::Polygon { corners }).unwrap();
        assert!(scenario::read(&Source::new("drawn.yaml", text)).is_ok());
    }
}
