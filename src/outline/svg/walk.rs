//! The way through a document.

use std::collections::HashMap;

use roxmltree::Node;

use crate::diagnostic::Source;

use super::super::found::Outlines;
use super::super::plane::Plane;
use super::super::{OutlineError, OutlineFault};
use super::attribute::{inner, length_or_zero};
use super::{path, shape};

/// How deep elements may lie in each other.
const DEEPEST: usize = 100;

/// The most steps: one for each node and one more for so many bytes of its attributes, and what `use` repeats counts each
/// time. A file without `use` always has fewer.
const MOST_STEPS: usize = 1_000_000;
const BYTES_PER_STEP: usize = 64;

/// A way through a document, and what was found on it.
pub(super) struct Walk<'d> {
    /// The elements that can be referred to.
    pub(super) named: HashMap<&'d str, Node<'d, 'd>>,
    /// The text, for lines.
    pub(super) source: Source,
    pub(super) outlines: Outlines,
    pub(super) steps: usize,
}

impl<'d> Walk<'d> {
    /// Takes one element as its ancestors show it, be it visible or not.
    pub(super) fn one(&mut self, node: Node<'d, 'd>, root: &Plane) -> Result<(), OutlineError> {
        let mut plane = *root;
        let above: Vec<_> = node.ancestors().skip(1).filter(Node::is_element).collect();
        for outer in above.into_iter().rev() {
            plane = self.within(outer, &plane)?;
        }
        self.step(node, 0)?;
        self.draw(node, &plane, 0)
    }

    /// Counts what it costs to look at a node, before that is done.
    fn step(&mut self, node: Node<'d, 'd>, depth: usize) -> Result<(), OutlineError> {
        let bytes: usize = node.attributes().map(|attribute| attribute.name().len() + attribute.value().len()).sum();
        self.steps += 1 + bytes / BYTES_PER_STEP;
        if depth > DEEPEST {
            return Err(self.at(node, OutlineFault::TooLarge { what: "elements in each other", limit: DEEPEST }));
        }
        if self.steps > MOST_STEPS {
            let what = "elements and numbers, with what `use` repeats";
            return Err(self.at(node, OutlineFault::TooLarge { what, limit: MOST_STEPS }));
        }
        Ok(())
    }

    /// Takes what is to be seen of an element and what is in it.
    pub(super) fn all(&mut self, node: Node<'d, 'd>, plane: &Plane, depth: usize) -> Result<(), OutlineError> {
        self.step(node, depth)?;
        let hidden = |style: &str| style.split(';').any(|rule| rule.replace(' ', "") == "display:none");
        let is_hidden = node.attribute("display") == Some("none") || node.attribute("style").is_some_and(hidden);
        // A symbol is there to be used.
        if is_hidden || is(node, "symbol") {
            return Ok(());
        }
        self.draw(node, plane, depth)
    }

    fn draw(&mut self, node: Node<'d, 'd>, plane: &Plane, depth: usize) -> Result<(), OutlineError> {
        match node.tag_name().name() {
            "svg" | "g" | "a" | "symbol" | "switch" => {
                let plane = self.within(node, plane)?;
                // Texts and comments count as steps, too.
                for child in node.children() {
                    self.all(child, &plane, depth + 1)?;
                }
            }
            "use" => self.repeat(node, plane, depth)?,
            "path" | "rect" | "circle" | "ellipse" | "line" | "polyline" | "polygon" => {
                let plane = self.within(node, plane)?;
                let drawn = if is(node, "path") { path::read(node, &plane) } else { shape::read(node, &plane) };
                let drawn = drawn.map_err(|fault| self.at(node, fault))?;
                // Lines are counted for those few only that draw something.
                let line = if drawn.is_empty() { None } else { Some(self.line(node)) };
                for pieces in drawn {
                    self.outlines.add(pieces, line)?;
                }
            }
            // Definitions, texts, pictures and what programs keep for themselves.
            _ => {}
        }
        Ok(())
    }

    /// Draws what a `use` refers to.
    fn repeat(&mut self, node: Node<'d, 'd>, plane: &Plane, depth: usize) -> Result<(), OutlineError> {
        let link = node.attributes().find(|attribute| attribute.name() == "href").map_or("", |link| link.value());
        let Some(&found) = link.strip_prefix('#').and_then(|target| self.named.get(target)) else {
            let reason = format!("`use` refers to `{}`, which is not there", link.chars().take(40).collect::<String>());
            return Err(self.at(node, OutlineFault::Syntax { reason }));
        };
        let plane = self.within(node, plane)?;
        let offset = length_or_zero(node, "x").and_then(|x| Ok([x, length_or_zero(node, "y")?]));
        let offset = offset.map_err(|fault| self.at(node, fault))?;
        let plane = plane.inner([1.0, 0.0], [0.0, 1.0], offset);
        if !is(found, "symbol") {
            return self.all(found, &plane, depth + 1);
        }
        self.step(found, depth + 1)?;
        self.draw(found, &plane, depth + 1)
    }

    /// The plane within an element.
    fn within(&self, node: Node<'d, 'd>, plane: &Plane) -> Result<Plane, OutlineError> {
        let is_root = node.parent().is_none_or(|parent| parent.is_root());
        let fits = node.attribute("viewBox").is_some() || is(node, "svg");
        if fits && !is_root {
            let what = format!("`{}` with a frame of its own", node.tag_name().name());
            let advice = "take its contents out of it, or use a group with a `transform`";
            return Err(self.at(node, OutlineFault::Unsupported { what, advice }));
        }
        inner(node, plane).map_err(|fault| self.at(node, fault))
    }

    fn at(&self, node: Node<'d, 'd>, fault: OutlineFault) -> OutlineError {
        fault.at(Some(self.line(node)))
    }

    fn line(&self, node: Node<'d, 'd>) -> usize {
        self.source.line_column(node.range().start).line
    }
}

/// Whether an element has this name, in whatever namespace.
fn is(node: Node<'_, '_>, name: &str) -> bool {
    node.tag_name().name() == name
}
