//! SVG: shapes and paths with their transforms.

mod arc;
mod attribute;
mod bounds;
mod paint;
mod path;
mod root;
mod shape;
mod styles;
mod walk;

use std::collections::HashMap;

use roxmltree::{Document, Node, ParsingOptions};

use vibrissa_runtime::units::suggest;
use vibrissa_text::diagnostic::{Source, utf8};

use super::outline_list::{Outline, OutlineList};
use super::{OutlineError, OutlineFault, ReadOptions};
use paint::Look;
use styles::Styles;
use walk::Walk;

/// The largest number of elements, attributes and texts of a document.
const MAX_NODES: u32 = 500_000;

/// Reads the outlines of all shapes, or of the shapes in one element.
pub(super) fn read(bytes: &[u8], options: &ReadOptions<'_>) -> Result<Vec<Outline>, OutlineError> {
    let text = utf8(bytes).map_err(OutlineFault::NotUtf8)?;
    bounds::check(text)?;
    // Drawing programs write a document type.
    let parsing = ParsingOptions { allow_dtd: true, nodes_limit: MAX_NODES, ..ParsingOptions::default() };
    let document = Document::parse_with_options(text, parsing).map_err(|error| {
        // The parser reports 1:1 if the position is unknown.
        let line = usize::try_from(error.pos().row).ok().filter(|&row| row > 1 || error.pos().col > 1);
        syntax(&error.to_string()).at(line)
    })?;
    let root = document.root_element();
    if root.tag_name().name() != "svg" {
        let reason = format!("it is no SVG: it begins with `{}`", root.tag_name().name());
        return Err(OutlineFault::Syntax { reason }.into());
    }
    let source = Source::new("", text);
    let line = |node: Node<'_, '_>| Some(source.line_column(node.range().start).line);
    let styles = Styles::read(document.root()).map_err(|(node, fault)| fault.at(line(node)))?;
    let transform = root::transform(root, options.unit, &styles)?;
    let ids = document.descendants().filter_map(|node| Some((node.attribute("id")?, node)));
    // Of two elements with one id, the first counts.
    let named: HashMap<_, _> = ids.rev().collect();
    let mut walk =
        Walk { named, source, styles, outlines: OutlineList::default(), unseen: 0, steps: 0, used: Vec::new() };
    let Some(element) = options.element else {
        walk.read_visible(root, &transform, 0, Look::initial())?;
        return walk.outlines.into_visible(walk.unseen);
    };
    let Some(&node) = walk.named.get(element) else {
        let mut ids: Vec<&str> = walk.named.keys().copied().collect();
        ids.sort_unstable();
        let meant = suggest(element, ids).map(str::to_owned);
        return Err(OutlineFault::NoElement { element: element.to_owned(), meant }.into());
    };
    walk.read_element(node, &transform)?;
    walk.outlines.into_visible(walk.unseen)
}

fn syntax(reason: &str) -> OutlineFault {
    OutlineFault::Syntax { reason: reason.to_owned() }
}
