//! DXF: lines, arcs, circles, ellipses, polylines, splines and blocks in top view.

mod drawing;
mod entity;
mod pair;
mod polyline;
mod record;
mod spline;
mod walk;

use super::outline_list::Outline;
use super::transform::Transform;
use super::{OutlineError, OutlineFault, ReadOptions};
use drawing::Drawing;
use walk::Walk;

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
    let unit = options.unit.map_or_else(|| drawing.unit(), Ok)?;
    Walk::new(&drawing, options.element).read(&Transform::scaled(unit))
}
