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

/// The most elements that are visited: those that `use` repeats count each time.
const MOST_STEPS: usize = 500_000;

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
        self.draw(node, &plane, 0)
    }

    /// Takes what is to be seen of an element and what is in it.
    pub(super) fn all(&mut self, node: Node<'d, 'd>, plane: &Plane, depth: usize) -> Result<(), OutlineError> {
        let hidden = |style: &str| style.split(';').any(|rule| rule.replace(' ', "") == "display:none");
        let is_hidden = node.attribute("display") == Some("none") || node.attribute("style").is_some_and(hidden);
        // A symbol is there to be used.
        if is_hidden || is(node, "symbol") {
            return Ok(());
        }
        self.draw(node, plane, depth)
    }

    fn draw(&mut self, node: Node<'d, 'd>, plane: &Plane, depth: usize) -> Result<(), OutlineError> {
        self.steps += 1;
        if depth > DEEPEST {
            return Err(self.at(node, OutlineFault::TooLarge { what: "elements in each other", limit: DEEPEST }));
        }
        if self.steps > MOST_STEPS {
            return Err(self.at(node, OutlineFault::TooLarge { what: "elements", limit: MOST_STEPS }));
        }
        match node.tag_name().name() {
            "svg" | "g" | "a" | "symbol" | "switch" => {
                let plane = self.within(node, plane)?;
                for child in node.children().filter(Node::is_element) {
                    self.all(child, &plane, depth + 1)?;
                }
            }
            "use" => self.repeat(node, plane, depth)?,
            "path" | "rect" | "circle" | "ellipse" | "line" | "polyline" | "polygon" => {
                let plane = self.within(node, plane)?;
                let drawn = if is(node, "path") { path::read(node, &plane) } else { shape::read(node, &plane) };
                let line = Some(self.line(node));
                for pieces in drawn.map_err(|fault| fault.at(line))? {
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
        if is(found, "symbol") { self.draw(found, &plane, depth + 1) } else { self.all(found, &plane, depth + 1) }
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
