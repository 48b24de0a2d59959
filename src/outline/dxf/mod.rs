//! DXF: lines, arcs, circles, ellipses and polylines in top view.

mod drawing;
mod entity;
mod pair;
mod record;

use vibrissa_runtime::units::suggest;

use super::assemble::assemble;
use super::outline_list::{Outline, OutlineList};
use super::transform::Transform;
use super::{MAX_PIECES, OutlineError, OutlineFault, ReadOptions};
use drawing::Drawing;
use entity::{EntityGeometry, geometry};
use record::Record;

/// The beginning of a binary DXF.
const BINARY: &[u8] = b"AutoCAD Binary DXF";

/// Reads the outlines of all visible layers, or of one layer.
pub(super) fn read(bytes: &[u8], options: &ReadOptions<'_>) -> Result<Vec<Outline>, OutlineError> {
    if bytes.starts_with(BINARY) {
        let advice = "save it as a DXF of text (ASCII)";
        return Err(OutlineFault::Unsupported { what: "a binary DXF".to_owned(), advice }.into());
    }
    // Older files have names in other encodings. Everything else is ASCII.
    let text = String::from_utf8_lossy(bytes);
    let drawing = Drawing::read(&text)?;
    let transform = Transform::scaled(options.unit.or(drawing.unit).ok_or(OutlineFault::NoUnit)?);
    let mut outlines = OutlineList::default();
    let mut loose = Vec::new();
    for entity in chosen(&drawing, options.element)? {
        match geometry(entity, &transform).map_err(|error| error.or_at(entity.line))? {
            EntityGeometry::Nothing => {}
            EntityGeometry::Whole(pieces) => outlines.add(pieces, Some(entity.line))?,
            EntityGeometry::Loose(pieces) => loose.extend(pieces.into_iter().map(|piece| (piece, Some(entity.line)))),
        }
        if loose.len() > MAX_PIECES {
            return Err(OutlineFault::TooLarge { what: "lines and arcs", limit: MAX_PIECES }.at(Some(entity.line)));
        }
    }
    for (pieces, line) in assemble(&loose)? {
        outlines.add(pieces, line)?;
    }
    outlines.into_outlines()
}

/// The entities of a layer, or all visible entities. Names of layers are case-insensitive.
fn chosen<'d>(drawing: &'d Drawing<'_>, layer: Option<&str>) -> Result<Vec<&'d Record<'d>>, OutlineError> {
    let in_the_model = drawing.entities.iter().filter(|entity| !entity.is_on_paper());
    let Some(layer) = layer else {
        let is_seen =
            |entity: &&Record<'_>| entity.is_visible() && !drawing.hidden.contains(&entity.layer().to_lowercase());
        return Ok(in_the_model.filter(is_seen).collect());
    };
    let is_named = |entity: &&Record<'_>| entity.layer().to_lowercase() == layer.to_lowercase();
    let entities: Vec<_> = in_the_model.clone().filter(is_named).collect();
    if entities.is_empty() {
        let mut names: Vec<&str> = in_the_model.map(Record::layer).collect();
        names.sort_unstable();
        names.dedup();
        let meant = suggest(layer, names).map(str::to_owned);
        return Err(OutlineFault::NoElement { element: layer.to_owned(), meant }.into());
    }
    Ok(entities)
}
