//! Whether outlines of a file keep apart.

use crate::geometry::Contour;

use super::found::Outline;
use super::{OutlineError, OutlineFault};

/// Whether none of the outlines lies inside another or meets it; the first that does is told.
pub(super) fn check(outlines: &[Outline]) -> Result<(), OutlineError> {
    for (index, second) in outlines.iter().enumerate() {
        for first in &outlines[..index] {
            if !first.contour.overlaps(&second.contour) {
                continue;
            }
            let (outer, inner) =
                if is_inside(&first.contour, &second.contour) { (second, first) } else { (first, second) };
            let fault = if is_inside(&inner.contour, &outer.contour) {
                OutlineFault::Hole { outer_line: outer.line }
            } else {
                OutlineFault::Overlap { other_line: outer.line }
            };
            return Err(fault.at(inner.line));
        }
    }
    Ok(())
}

fn is_inside(inner: &Contour, outer: &Contour) -> bool {
    inner
        .pieces()
        .iter()
        .all(|piece| outer.contains(piece.start()) && outer.contains(piece.point_at(0.5 * piece.length())))
}
