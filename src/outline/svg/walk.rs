//! The traversal of a document.

use std::collections::HashMap;

use roxmltree::Node;

use crate::diagnostic::Source;

use super::super::outline_list::OutlineList;
use super::super::transform::Transform;
use super::super::{OutlineError, OutlineFault};
use super::attribute::{inner, is_intricate, length_or_zero, property};
use super::{path, shape};

/// The largest nesting depth of elements.
const DEEPEST: usize = 100;

/// The largest number of steps. A node counts one step, plus a share for the bytes of its attributes. Content repeated
/// by `use` counts each time. A file without `use` never reaches the limit.
const MAX_STEPS: usize = 1_000_000;
const BYTES_PER_STEP: usize = 64;

/// A traversal of a document with its results.
pub(super) struct Walk<'d> {
    /// The elements with an id.
    pub(super) named: HashMap<&'d str, Node<'d, 'd>>,
    /// The text, for line numbers.
    pub(super) source: Source,
    pub(super) outlines: OutlineList,
    pub(super) steps: usize,
}

impl<'d> Walk<'d> {
    /// Reads one element with the transforms of its ancestors, regardless of its visibility.
    pub(super) fn read_element(&mut self, node: Node<'d, 'd>, root: &Transform) -> Result<(), OutlineError> {
        let mut transform = *root;
        let above: Vec<_> = node.ancestors().skip(1).filter(Node::is_element).collect();
        for outer in above.into_iter().rev() {
            transform = self.inner_transform(outer, &transform)?;
        }
        self.count_step(node, 0)?;
        self.draw(node, &transform, 0, true)
    }

    /// Counts the cost of a node before it is read.
    fn count_step(&mut self, node: Node<'d, 'd>, depth: usize) -> Result<(), OutlineError> {
        let bytes: usize = node.attributes().map(|attribute| attribute.name().len() + attribute.value().len()).sum();
        self.steps += 1 + bytes / BYTES_PER_STEP;
        if depth > DEEPEST {
            return Err(self.at(node, OutlineFault::TooLarge { what: "elements in each other", limit: DEEPEST }));
        }
        if self.steps > MAX_STEPS {
            let what = "elements and numbers, with what `use` repeats";
            return Err(self.at(node, OutlineFault::TooLarge { what, limit: MAX_STEPS }));
        }
        if is_intricate(node) {
            let what = "a comment or a backslash in a `style`".to_owned();
            return Err(self.at(node, OutlineFault::Unsupported { what, advice: "take it out" }));
        }
        Ok(())
    }

    /// Reports style sheets, because they may hide, move or change any element.
    pub(super) fn check(&self, document: Node<'d, 'd>) -> Result<(), OutlineError> {
        let is_sheet = |node: &Node<'_, '_>| {
            is(*node, "style") || node.pi().is_some_and(|instruction| instruction.target == "xml-stylesheet")
        };
        let Some(sheet) = document.descendants().find(is_sheet) else { return Ok(()) };
        let what = "a style sheet".to_owned();
        let advice = "save it with the properties as attributes of the elements, and take the sheet out";
        Err(self.at(sheet, OutlineFault::Unsupported { what, advice }))
    }

    /// Reads the visible content of an element. `is_visible` is the inherited visibility.
    pub(super) fn read_visible(
        &mut self,
        node: Node<'d, 'd>,
        transform: &Transform,
        depth: usize,
        is_visible: bool,
    ) -> Result<(), OutlineError> {
        self.count_step(node, depth)?;
        let is_hidden = property(node, "display").is_some_and(|value| value.eq_ignore_ascii_case("none"));
        // A symbol is drawn only by `use`.
        if is_hidden || is(node, "symbol") {
            return Ok(());
        }
        self.draw(node, transform, depth, visibility(node).unwrap_or(is_visible))
    }

    fn draw(
        &mut self,
        node: Node<'d, 'd>,
        transform: &Transform,
        depth: usize,
        is_visible: bool,
    ) -> Result<(), OutlineError> {
        match node.tag_name().name() {
            "svg" | "g" | "a" | "symbol" => {
                let transform = self.inner_transform(node, transform)?;
                // Texts and comments also count as steps.
                for child in node.children() {
                    self.read_visible(child, &transform, depth + 1, is_visible)?;
                }
            }
            "use" => self.draw_use(node, transform, depth, is_visible)?,
            "switch" => {
                let what = "`switch`, which shows one of several things,".to_owned();
                let advice = "put what it is to show in its place";
                return Err(self.at(node, OutlineFault::Unsupported { what, advice }));
            }
            // Parts of a hidden group may be visible, but a hidden shape is not.
            "path" | "rect" | "circle" | "ellipse" | "line" | "polyline" | "polygon" if is_visible => {
                let transform = self.inner_transform(node, transform)?;
                let drawn = if is(node, "path") { path::read(node, &transform) } else { shape::read(node, &transform) };
                let drawn = drawn.map_err(|fault| self.at(node, fault))?;
                // Lines are computed only for the few elements that draw something.
                let line = if drawn.is_empty() { None } else { Some(self.line(node)) };
                for pieces in drawn {
                    self.outlines.add(pieces, line)?;
                }
            }
            // Definitions, texts, images and data of drawing programs.
            _ => {}
        }
        Ok(())
    }

    /// Draws the target of a `use` element.
    fn draw_use(
        &mut self,
        node: Node<'d, 'd>,
        transform: &Transform,
        depth: usize,
        is_visible: bool,
    ) -> Result<(), OutlineError> {
        let link = node.attributes().find(|attribute| attribute.name() == "href").map_or("", |link| link.value());
        let Some(&found) = link.strip_prefix('#').and_then(|target| self.named.get(target)) else {
            let reason = format!("`use` refers to `{}`, which is not there", link.chars().take(40).collect::<String>());
            return Err(self.at(node, OutlineFault::Syntax { reason }));
        };
        let transform = self.inner_transform(node, transform)?;
        let offset = length_or_zero(node, "x").and_then(|x| Ok([x, length_or_zero(node, "y")?]));
        let offset = offset.map_err(|fault| self.at(node, fault))?;
        let transform = transform.inner([1.0, 0.0], [0.0, 1.0], offset);
        if !is(found, "symbol") {
            return self.read_visible(found, &transform, depth + 1, is_visible);
        }
        self.count_step(found, depth + 1)?;
        self.draw(found, &transform, depth + 1, visibility(found).unwrap_or(is_visible))
    }

    /// The transform within an element.
    fn inner_transform(&self, node: Node<'d, 'd>, transform: &Transform) -> Result<Transform, OutlineError> {
        let is_root = node.parent().is_none_or(|parent| parent.is_root());
        let fits = node.attribute("viewBox").is_some() || is(node, "svg");
        if fits && !is_root {
            let what = format!("`{}` with a frame of its own", node.tag_name().name());
            let advice = "take its contents out of it, or use a group with a `transform`";
            return Err(self.at(node, OutlineFault::Unsupported { what, advice }));
        }
        inner(node, transform).map_err(|fault| self.at(node, fault))
    }

    fn at(&self, node: Node<'d, 'd>, fault: OutlineFault) -> OutlineError {
        fault.at(Some(self.line(node)))
    }

    fn line(&self, node: Node<'d, 'd>) -> usize {
        self.source.line_column(node.range().start).line
    }
}

/// The visibility that an element states itself.
fn visibility(node: Node<'_, '_>) -> Option<bool> {
    match property(node, "visibility")?.to_ascii_lowercase().as_str() {
        "hidden" | "collapse" => Some(false),
        "visible" | "initial" => Some(true),
        _ => None,
    }
}

/// True if an element has this name, in any namespace.
fn is(node: Node<'_, '_>, name: &str) -> bool {
    node.tag_name().name() == name
}
