//! Scenarios whose values are drawn: one file describes a family of scenes.
//!
//! The section `draw` names what is drawn, and `$name` in a value stands for what was drawn. An item of `objects` can have a
//! section of its own, and `repeat`. The section `require` has conditions that every scene meets.

mod distribution;
mod resolve;

use distribution::Distribution;
use resolve::{Draws, resolve};

use super::change::flow;
use super::reader::Reader;
use super::{fault, scene};
use crate::geometry::Contour;
use crate::scenario::Files;
use crate::scene::Scene;
use crate::solid::Solid;
use vibrissa_runtime::units::{Dimension, Key};
use vibrissa_text::diagnostic::{Diagnostic, Source, Span};
use vibrissa_yaml::{Entry, Fields, Node, Placed, parse};

/// The most draws of one scene. Conditions that one draw of 50 meets are met by one of these with a probability of 98 %.
const DRAWS: usize = 200;
/// Points on an outline at which its distance from another is computed, as a share of the gap between them.
const GAP_SPACING: f64 = 0.05;
/// The least distance between two objects.
const GAP: Key = Key::new("gap", Dimension::LENGTH, (0.0, 100.0), "60 mm");

/// A scenario with values that are drawn.
#[derive(Debug, Clone)]
pub struct DrawnScenario {
    name: String,
    source: Source,
    /// The tree without `draw` and `require`.
    tree: Placed<Node>,
    draws: Draws,
    /// The least distance between two objects (m), with its position in the text.
    gap: Option<Placed<f64>>,
}

/// One scene of a drawn scenario.
#[derive(Debug, Clone)]
pub struct DrawnScene {
    /// The scene as a scenario without `draw`.
    pub text: String,
    /// The same scene.
    pub scene: Scene,
}

impl DrawnScenario {
    /// Reads a scenario that draws its values. `None` if the text does not contain `draw`.
    ///
    /// # Errors
    /// All diagnostics about what is drawn. Those about a scene come with [`scene`](Self::scene).
    pub fn read(source: &Source) -> Result<Option<Self>, Vec<Diagnostic>> {
        let (mut tree, faults) = parse(source, "scenario")?;
        let mut no_files = |_: &str| Err("a family needs no files to be read".to_owned());
        let mut reader = Reader::new(source, &mut no_files, faults);
        let (Some(draw), require) = (take(&mut tree, "draw"), take(&mut tree, "require")) else { return Ok(None) };
        let draws = Draws::read(&mut reader, &draw.value);
        let gap = require.map(|require| {
            let mut fields = Fields::of(&mut reader, &require.value, "what a family requires", require.key.span)?;
            let gap = fields.number(&mut reader, &GAP);
            fields.finish(&mut reader);
            gap
        });
        if let Some(draws) = &draws {
            resolve::check_uses(&mut reader, &tree, draws);
        }
        let name = match tree.entry("name") {
            Some(entry) => scene::name(&mut reader, entry, "a family", "its scenes have this name and their number"),
            None => Some("family".to_owned()),
        };
        let read = name.zip(draws);
        let read = read.map(|(name, draws)| Self { name, source: source.clone(), tree, draws, gap: gap.flatten() });
        reader.finish(read).map(Some)
    }

    /// Its name.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The text that was read.
    #[must_use]
    pub fn source(&self) -> &Source {
        &self.source
    }

    /// A scene with the values that `share` draws: numbers from 0 to less than 1, which are independent and uniformly
    /// distributed. It has this `name` and this seed of its noise. A scene with an error, such as an object at the start, or
    /// one that misses a condition is drawn again.
    ///
    /// # Errors
    /// The diagnostics of the last draw, if no draw is a scene.
    pub fn scene(
        &self,
        name: &str,
        seed: u64,
        share: &mut dyn FnMut() -> f64,
        files: &mut Files<'_>,
    ) -> Result<DrawnScene, Vec<Diagnostic>> {
        let mut faults = Vec::new();
        for _ in 0..DRAWS {
            let mut tree = resolve(&self.tree, &self.draws, share).map_err(|fault| vec![*fault])?;
            set(&mut tree, "name", Node::Text(name.to_owned()));
            set(&mut tree, "seed", Node::Integer(seed.into()));
            let mut reader = Reader::new(&self.source, files, Vec::new());
            let read = scene::read_scene(&mut reader, &tree);
            match (reader.finish(read), &self.gap) {
                (Ok(scene), Some(gap)) if !has_gap(&scene, count(&tree), gap.value) => faults = vec![too_narrow(gap)],
                (Ok(scene), _) => return Ok(DrawnScene { text: text(&tree), scene }),
                (Err(found), _) => faults = found,
            }
        }
        Err(faults)
    }
}

/// Removes an entry of a mapping.
fn take(tree: &mut Placed<Node>, key: &str) -> Option<Entry> {
    let Node::Mapping(entries) = &mut tree.value else { return None };
    let index = entries.iter().position(|entry| entry.key.value == key)?;
    Some(entries.remove(index))
}

/// Sets an entry at the root of a scenario. A new one has the position of the root.
fn set(tree: &mut Placed<Node>, key: &str, value: Node) {
    let span = tree.span;
    let Node::Mapping(entries) = &mut tree.value else { return };
    match entries.iter_mut().find(|entry| entry.key.value == key) {
        Some(entry) => entry.value.value = value,
        None => entries.push(Entry { key: Placed { value: key.to_owned(), span }, value: Placed { value, span } }),
    }
}

/// The scenario as text, with a line for each key and for each item of a list at the root.
fn text(tree: &Placed<Node>) -> String {
    let Node::Mapping(entries) = &tree.value else { return flow(&tree.value) + "\n" };
    let lines = entries.iter().map(|Entry { key, value }| match &value.value {
        Node::List(items) => {
            let items = items.iter().map(|item| format!("  - {}\n", flow(&item.value)));
            format!("{}:\n{}", key.value, items.collect::<String>())
        }
        value => format!("{}: {}\n", key.value, flow(value)),
    });
    lines.collect()
}

/// The number of objects.
fn count(tree: &Placed<Node>) -> usize {
    match tree.entry("objects").map(|objects| &objects.value.value) {
        Some(Node::List(items)) => items.len(),
        _ => 0,
    }
}

/// True if all `objects` are at least this far (m) from each other. Objects that overlap have become one solid. An outline is sampled, so a scene whose gap is larger by less
/// than half a spacing can be refused.
fn has_gap(scene: &Scene, objects: usize, gap: f64) -> bool {
    if scene.solids.len() < objects {
        return false;
    }
    let outlines: Vec<&Contour> = scene.solids.iter().map(Solid::surface).collect();
    let spacing = GAP_SPACING * gap;
    let is_apart = |one: &Contour, other: &Contour| {
        let points = (one.length() / spacing).ceil().max(1.0);
        let step = one.length() / points;
        let mut at = 0.0;
        while at <= one.length() {
            if other.is_within(gap + 0.5 * step, one.point_at(at)) {
                return false;
            }
            at += step;
        }
        true
    };
    gap <= 0.0 || outlines.iter().enumerate().all(|(k, one)| outlines[k + 1..].iter().all(|other| is_apart(one, other)))
}

fn too_narrow(gap: &Placed<f64>) -> Diagnostic {
    let message = format!("none of {DRAWS} draws has this gap between its objects");
    let label = "is hardly ever met";
    Diagnostic::error(fault::RANGE, message, gap.span, label)
        .hint("draw smaller objects, or places that are farther apart")
}

/// The name of what a text such as `$radius` or `-$radius` stands for, and true if it is negative.
fn drawn_name(text: &str) -> Option<(&str, bool)> {
    let (rest, is_negative) = text.strip_prefix('-').map_or((text, false), |rest| (rest, true));
    let name = rest.strip_prefix('$')?;
    let is_name = !name.is_empty() && name.chars().all(|letter| letter.is_ascii_alphanumeric() || letter == '_');
    is_name.then_some((name, is_negative))
}

/// Where a name that was never drawn is used.
fn unknown(name: &str, span: Span, known: &[&str]) -> Diagnostic {
    let message = format!("`{name}` is not drawn");
    let fault = Diagnostic::error(fault::NAME, message, span, "no such name in `draw`");
    let hint = if known.is_empty() { "`draw` is empty".to_owned() } else { format!("drawn are {}", known.join(", ")) };
    fault.hint(hint)
}
