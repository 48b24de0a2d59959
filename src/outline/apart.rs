//! Whether outlines of a file keep out of each other.

use crate::geometry::Contour;

use super::found::Outline;
use super::{OutlineError, OutlineFault};

/// Whether none of the outlines lies inside another, where it may be meant for a hole; the first that does is told.
pub(super) fn check(outlines: &[Outline]) -> Result<(), OutlineError> {
    for (index, second) in outlines.iter().enumerate() {
        for first in &outlines[..index] {
            let (outer, inner) =
                if is_inside(&first.contour, &second.contour) { (second, first) } else { (first, second) };
            if is_inside(&inner.contour, &outer.contour) {
                return Err(OutlineFault::Hole { outer_line: outer.line }.at(inner.line));
            }
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
