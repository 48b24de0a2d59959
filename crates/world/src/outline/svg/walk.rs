//! The traversal of a document.

use std::collections::HashMap;

use roxmltree::{Node, NodeId};

use vibrissa_text::diagnostic::Source;

use super::super::outline_list::OutlineList;
use super::super::transform::Transform;
use super::super::{OutlineError, OutlineFault};
use super::attribute::{inner, is_intricate, length_or_zero};
use super::paint::{Look, is_transparent, is_undrawn};
use super::styles::Styles;
use super::{path, shape};

/// The largest nesting depth of elements.
const DEEPEST: usize = 100;

/// The largest number of steps. A node counts one step, plus a share for the bytes of its attributes and of its
/// rules in style sheets. Content repeated
/// by `use` counts each time. A file without `use` never reaches the limit.
const MAX_STEPS: usize = 1_000_000;
const BYTES_PER_STEP: usize = 64;

/// A traversal of a document with its results.
pub(super) struct Walk<'d> {
    /// The elements with an id.
    pub(super) named: HashMap<&'d str, Node<'d, 'd>>,
    pub(super) styles: Styles,
    /// The text, for line numbers.
    pub(super) source: Source,
    pub(super) outlines: OutlineList,
    /// The number of shapes and groups that cannot be seen.
    pub(super) unseen: usize,
    pub(super) steps: usize,
    /// The elements that `use` is drawing, from the outermost.
    pub(super) used: Vec<NodeId>,
}

impl<'d> Walk<'d> {
    /// Reads one element with the transforms of its ancestors, even if it is hidden. If nothing in it is visible, everything in it is
    /// read.
    pub(super) fn read_element(&mut self, node: Node<'d, 'd>, root: &Transform) -> Result<(), OutlineError> {
        let mut transform = *root;
        let mut look = Look::initial();
        let above: Vec<_> = node.ancestors().skip(1).filter(Node::is_element).collect();
        for outer in above.into_iter().rev() {
            transform = self.inner_transform(outer, &transform)?;
            look = look.inner(outer, &self.named, &self.styles);
        }
        let look = look.inner(node, &self.named, &self.styles).shown();
        self.count_step(node, 0)?;
        self.draw(node, &transform, 0, look)?;
        if self.outlines.is_empty() && self.unseen > 0 {
            self.draw(node, &transform, 0, look.forced())?;
        }
        Ok(())
    }

    /// Counts the cost of a node before it is read.
    fn count_step(&mut self, node: Node<'d, 'd>, depth: usize) -> Result<(), OutlineError> {
        let bytes: usize = node.attributes().map(|attribute| attribute.name().len() + attribute.value().len()).sum();
        self.steps += 1 + (bytes + self.styles.size(node)) / BYTES_PER_STEP;
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

    /// Reads the visible content of an element. `look` is that of the element around it.
    pub(super) fn read_visible(
        &mut self,
        node: Node<'d, 'd>,
        transform: &Transform,
        depth: usize,
        look: Look,
    ) -> Result<(), OutlineError> {
        self.count_step(node, depth)?;
        // A symbol is drawn only by `use`.
        if is(node, "symbol") {
            return Ok(());
        }
        if is_undrawn(node, &self.styles) || is_transparent(node, &self.styles) {
            self.unseen += 1;
            return Ok(());
        }
        self.draw(node, transform, depth, look.inner(node, &self.named, &self.styles))
    }

    /// Draws an element with its own look.
    fn draw(
        &mut self,
        node: Node<'d, 'd>,
        transform: &Transform,
        depth: usize,
        look: Look,
    ) -> Result<(), OutlineError> {
        match node.tag_name().name() {
            "svg" | "g" | "a" | "symbol" => {
                let transform = self.inner_transform(node, transform)?;
                // Texts and comments also count as steps.
                for child in node.children() {
                    self.read_visible(child, &transform, depth + 1, look)?;
                }
            }
            "use" => self.draw_use(node, transform, depth, look)?,
            "switch" => {
                let what = "`switch`, which shows one of several things,".to_owned();
                let advice = "put what it is to show in its place";
                return Err(self.at(node, OutlineFault::Unsupported { what, advice }));
            }
            "path" | "rect" | "circle" | "ellipse" | "line" | "polyline" | "polygon" => {
                // Parts of a hidden group may be visible, but a hidden shape is not.
                if !look.shows(node) {
                    self.unseen += 1;
                    return Ok(());
                }
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
        look: Look,
    ) -> Result<(), OutlineError> {
        let link = node.attributes().find(|attribute| attribute.name() == "href").map_or("", |link| link.value());
        let Some(&found) = link.strip_prefix('#').and_then(|target| self.named.get(target)) else {
            let reason = format!("`use` refers to `{}`, which is not there", link.chars().take(40).collect::<String>());
            return Err(self.at(node, OutlineFault::Syntax { reason }));
        };
        if self.used.contains(&found.id()) {
            let reason = format!("`use` of `{link}` draws itself");
            return Err(self.at(node, OutlineFault::Syntax { reason }));
        }
        self.used.push(found.id());
        let transform = self.inner_transform(node, transform)?;
        let offset = length_or_zero(node, "x").and_then(|x| Ok([x, length_or_zero(node, "y")?]));
        let offset = offset.map_err(|fault| self.at(node, fault))?;
        let transform = transform.inner([1.0, 0.0], [0.0, 1.0], offset);
        if is(found, "symbol") {
            self.count_step(found, depth + 1)?;
            if !is_transparent(found, &self.styles) {
                self.draw(found, &transform, depth + 1, look.inner(found, &self.named, &self.styles))?;
            }
        } else {
            self.read_visible(found, &transform, depth + 1, look)?;
        }
        self.used.pop();
        Ok(())
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
        inner(node, transform, &self.styles).map_err(|fault| self.at(node, fault))
    }

    fn at(&self, node: Node<'d, 'd>, fault: OutlineFault) -> OutlineError {
        fault.at(Some(self.line(node)))
    }

    fn line(&self, node: Node<'d, 'd>) -> usize {
        self.source.line_column(node.range().start).line
    }
}

/// True if an element has this name, in any namespace.
fn is(node: Node<'_, '_>, name: &str) -> bool {
    node.tag_name().name() == name
}
