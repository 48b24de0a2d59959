//! An outline that was found.

use crate::geometry::{Contour, ContourError, Piece};

use super::chain::close;
use super::{MOST_OUTLINES, MOST_PIECES, OutlineError, OutlineFault};

/// An outline, and the line of the file that it begins in, where that is known.
pub(super) struct Outline {
    pub(super) contour: Contour,
    pub(super) line: Option<usize>,
}

/// The outlines that have been found so far.
#[derive(Default)]
pub(super) struct Outlines {
    found: Vec<Outline>,
    pieces: usize,
}

impl Outlines {
    /// Adds the outline that `pieces` are, one behind the other, closed by at most a tolerance.
    pub(super) fn add(&mut self, pieces: Vec<Piece>, line: Option<usize>) -> Result<(), OutlineError> {
        self.pieces += pieces.len();
        if self.pieces > MOST_PIECES {
            return Err(OutlineFault::TooLarge { what: "lines and arcs", limit: MOST_PIECES }.at(line));
        }
        if self.found.len() >= MOST_OUTLINES {
            return Err(OutlineFault::TooLarge { what: "outlines", limit: MOST_OUTLINES }.at(line));
        }
        let contour = close(pieces).and_then(|pieces| Contour::closed(pieces).map_err(fault));
        self.found.push(Outline { contour: contour.map_err(|fault| fault.at(line))?, line });
        Ok(())
    }

    /// All of them, at least one.
    pub(super) fn into_found(self) -> Result<Vec<Outline>, OutlineError> {
        if self.found.is_empty() { Err(OutlineFault::NoOutline.into()) } else { Ok(self.found) }
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
