//! The outlines of a file.

use crate::geometry::{Contour, ContourError, Piece};

use super::chain::close;
use super::{MAX_OUTLINES, MAX_PIECES, OutlineError, OutlineFault};

/// An outline with the line of its beginning in the file, if that is known.
pub(super) struct Outline {
    pub(super) contour: Contour,
    pub(super) line: Option<usize>,
}

/// The outlines that have been read so far.
#[derive(Default)]
pub(super) struct OutlineList {
    outlines: Vec<Outline>,
    pieces: usize,
}

impl OutlineList {
    /// Adds the outline of consecutive `pieces`. Gaps within the tolerance are closed.
    pub(super) fn add(&mut self, pieces: Vec<Piece>, line: Option<usize>) -> Result<(), OutlineError> {
        self.pieces += pieces.len();
        if self.pieces > MAX_PIECES {
            return Err(OutlineFault::TooLarge { what: "lines and arcs", limit: MAX_PIECES }.at(line));
        }
        if self.outlines.len() >= MAX_OUTLINES {
            return Err(OutlineFault::TooLarge { what: "outlines", limit: MAX_OUTLINES }.at(line));
        }
        let contour = close(pieces).and_then(|pieces| Contour::closed(pieces).map_err(fault));
        self.outlines.push(Outline { contour: contour.map_err(|fault| fault.at(line))?, line });
        Ok(())
    }

    /// Returns all outlines, at least one.
    pub(super) fn into_outlines(self) -> Result<Vec<Outline>, OutlineError> {
        if self.outlines.is_empty() { Err(OutlineFault::NoOutline.into()) } else { Ok(self.outlines) }
    }
}

fn fault(error: ContourError) -> OutlineFault {
    match error {
        ContourError::SelfIntersection { at, .. } => OutlineFault::Crosses { at },
        ContourError::NotFinite { .. } => OutlineFault::FarOff,
        ContourError::Empty => OutlineFault::NoOutline,
        other => OutlineFault::Contour(other),
    }
}

/// Reports the first outline that lies inside of another, because it may be meant as a hole.
pub(super) fn check_nesting(outlines: &[Outline]) -> Result<(), OutlineError> {
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
