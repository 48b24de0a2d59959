//! The outlines of a file.

use crate::geometry::{Contour, ContourError, Piece};

use super::chain::close;
use super::transform::is_near;
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
    /// Adds the outline of consecutive `pieces`. Gaps within the tolerance are closed. A point is left out, because nothing can touch
    /// it.
    pub(super) fn add(&mut self, pieces: Vec<Piece>, line: Option<usize>) -> Result<(), OutlineError> {
        self.pieces += pieces.len();
        if self.pieces > MAX_PIECES {
            return Err(OutlineFault::TooLarge { what: "lines and arcs", limit: MAX_PIECES }.at(line));
        }
        if self.outlines.len() >= MAX_OUTLINES {
            return Err(OutlineFault::TooLarge { what: "outlines", limit: MAX_OUTLINES }.at(line));
        }
        let closed = close(pieces).map_err(|fault| fault.at(line))?;
        if closed.is_empty() {
            return Ok(());
        }
        let contour = Contour::closed(closed).map_err(|error| fault(error).at(line))?;
        // An arc may reach farther than its ends.
        let bounds = contour.bounding_box();
        if [bounds.min, bounds.max].iter().any(|corner| !is_near(*corner)) {
            return Err(OutlineFault::FarOff.at(line));
        }
        self.outlines.push(Outline { contour, line });
        Ok(())
    }

    pub(super) fn is_empty(&self) -> bool {
        self.outlines.is_empty()
    }

    /// Returns all outlines, at least one. `unseen` is the number of shapes that were left out because they are invisible.
    pub(super) fn into_visible(self, unseen: usize) -> Result<Vec<Outline>, OutlineError> {
        if self.is_empty() && unseen > 0 {
            Err(OutlineFault::Invisible { unseen }.into())
        } else {
            self.into_outlines()
        }
    }

    /// Returns all outlines, at least one.
    pub(super) fn into_outlines(self) -> Result<Vec<Outline>, OutlineError> {
        if self.is_empty() { Err(OutlineFault::NoOutline.into()) } else { Ok(self.outlines) }
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

/// Removes the outlines that lie inside of others.
pub(super) fn leave_out_nested(outlines: &mut Vec<Outline>) {
    let is_nested = |(index, inner): (usize, &Outline)| {
        let mut others = outlines.iter().enumerate().filter(|(other, _)| *other != index);
        // Of two equal outlines, each is inside the other. The first one is kept.
        others.any(|(other, outer)| {
            is_inside(&inner.contour, &outer.contour) && (other < index || !is_inside(&outer.contour, &inner.contour))
        })
    };
    let is_nested: Vec<bool> = outlines.iter().enumerate().map(is_nested).collect();
    let mut is_nested = is_nested.into_iter();
    outlines.retain(|_| is_nested.next() != Some(true));
}

fn is_inside(inner: &Contour, outer: &Contour) -> bool {
    inner
        .pieces()
        .iter()
        .all(|piece| outer.contains(piece.start()) && outer.contains(piece.point_at(0.5 * piece.length())))
}
