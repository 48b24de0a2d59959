//! SVG: shapes and paths with their transforms.

mod arc;
mod attribute;
mod bounds;
mod path;
mod root;
mod shape;
mod walk;

use std::collections::HashMap;

use roxmltree::{Document, ParsingOptions};

use crate::diagnostic::{Source, utf8};
use vibrissa_runtime::units::suggest;

use super::outline_list::{Outline, OutlineList};
use super::{OutlineError, OutlineFault, ReadOptions};
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
    let transform = root::transform(root, options.unit)?;
    let ids = document.descendants().filter_map(|node| Some((node.attribute("id")?, node)));
    // Of two elements with one id, the first counts.
    let named: HashMap<_, _> = ids.rev().collect();
    let mut walk = Walk { named, source: Source::new("", text), outlines: OutlineList::default(), steps: 0 };
    walk.check(document.root())?;
    let Some(element) = options.element else {
        walk.read_visible(root, &transform, 0, true)?;
        return walk.outlines.into_outlines();
    };
    let Some(&node) = walk.named.get(element) else {
        let mut ids: Vec<&str> = walk.named.keys().copied().collect();
        ids.sort_unstable();
        let meant = suggest(element, ids).map(str::to_owned);
        return Err(OutlineFault::NoElement { element: element.to_owned(), meant }.into());
    };
    walk.read_element(node, &transform)?;
    walk.outlines.into_outlines()
}

fn syntax(reason: &str) -> OutlineFault {
    OutlineFault::Syntax { reason: reason.to_owned() }
}
