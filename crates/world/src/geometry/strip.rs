//! Strips of constant width.

use super::{Arc, Contour, ContourError, JOIN_TOLERANCE, MIN_PIECE_LENGTH, Piece, Segment, Vector2, perpendicular};

/// A strip of constant width along a line. Its two sides are exactly parallel, with sharp corners at the corners of the
/// line.
///
/// The pieces of the sides correspond to the pieces of the line, in its direction. The pieces of one side are opposite
/// to those of the other.
#[derive(Clone, Debug)]
pub struct Strip {
    left: Contour,
    right: Contour,
}

/// A side of a strip, in the direction of its line.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum Side {
    /// The left.
    Left,
    /// The right.
    Right,
}

/// The reason why there is no strip along a line. Pieces are counted from 0.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum StripError {
    /// The strip is too wide for a piece: an arc is too tight, or a segment between two corners is too short.
    #[error("the strip is too wide for piece {piece} of its centre line: make it narrower, or the bend wider")]
    TooWide {
        /// The piece.
        piece: usize,
    },
    /// A corner is not between two straight pieces.
    #[error("the corner at the start of piece {piece} joins an arc: only straight pieces may meet at a corner")]
    Corner {
        /// The piece after the corner.
        piece: usize,
    },
    /// A side or the outline is not a contour.
    #[error("the strip intersects itself: {0}")]
    Contour(#[from] ContourError),
}

impl Side {
    /// The opposite side.
    #[must_use]
    pub fn opposite(self) -> Self {
        match self {
            Self::Left => Self::Right,
            Self::Right => Self::Left,
        }
    }
}

impl Strip {
    /// The strip of a `width` (m) with the centre line `line`.
    ///
    /// ```
    /// use std::f64::consts::PI;
    /// use vibrissa_world::geometry::{Path, Pose, Side, Strip};
    /// let line = Path::from(Pose::default()).straight(1.0).arc(0.5, PI).open()?;
    /// let strip = Strip::new(&line, 0.02)?;
    /// assert!((strip.side(Side::Left).length() - (1.0 + 0.49 * PI)).abs() < 1e-12);
    /// assert!((strip.outline()?.area() - 0.02 * line.length()).abs() < 1e-12);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`StripError`] when the line is too tight, or has corners that are not between straight pieces.
    pub fn new(line: &Contour, width: f64) -> Result<Self, StripError> {
        Ok(Self { left: parallel(line, -0.5 * width)?, right: parallel(line, 0.5 * width)? })
    }

    /// One of the sides, in the direction of the line.
    #[must_use]
    pub fn side(&self, side: Side) -> &Contour {
        match side {
            Side::Left => &self.left,
            Side::Right => &self.right,
        }
    }

    /// The outline of a strip along an open line. A strip along a closed line has two sides and no outline.
    ///
    /// # Errors
    /// [`StripError::Contour`] if the line is closed, or if the strip intersects itself.
    pub fn outline(&self) -> Result<Contour, StripError> {
        let (from, to) = (self.right.pieces(), self.left.pieces());
        let cap = |from: &Piece, to: &Piece| Piece::segment(from.end(), to.start());
        let back: Vec<Piece> = to.iter().rev().map(Piece::reversed).collect();
        let caps = (from.last().zip(back.first()), back.last().zip(from.first()));
        let (Some(far), Some(near)) = caps else { return Err(ContourError::Empty.into()) };
        let (far, near) = (cap(far.0, far.1), cap(near.0, near.1));
        Ok(Contour::closed([from, &[far], &back, &[near]].concat())?)
    }
}

/// The line moved to its right by `distance` (m), with sharp corners.
fn parallel(line: &Contour, distance: f64) -> Result<Contour, StripError> {
    let mut pieces = Vec::with_capacity(line.pieces().len());
    for (index, piece) in line.pieces().iter().enumerate() {
        pieces.push(moved(piece, distance).ok_or(StripError::TooWide { piece: index })?);
    }
    let last = pieces.len() - 1;
    for index in usize::from(!line.is_closed())..=last {
        let before = index.checked_sub(1).unwrap_or(last);
        if (pieces[index].start() - pieces[before].end()).norm() > JOIN_TOLERANCE {
            let corner = corner(&line.pieces()[before], &line.pieces()[index], distance);
            match corner.zip(straight(&pieces[before]).zip(straight(&pieces[index]))) {
                Some((corner, (into, out))) => {
                    pieces[before] = Piece::segment(into.start, corner);
                    pieces[index] = Piece::segment(corner, out.end);
                }
                None => return Err(StripError::Corner { piece: index }),
            }
        }
    }
    for (index, (piece, original)) in pieces.iter().zip(line.pieces()).enumerate() {
        let goes_back = straight(piece).is_some() && piece.tangent_at(0.0).dot(&original.tangent_at(0.0)) <= 0.0;
        if goes_back || piece.length() < MIN_PIECE_LENGTH {
            return Err(StripError::TooWide { piece: index });
        }
    }
    Ok(if line.is_closed() { Contour::closed(pieces)? } else { Contour::open(pieces)? })
}

/// A piece moved to its right. `None` for an arc whose centre is nearer than that.
fn moved(piece: &Piece, distance: f64) -> Option<Piece> {
    match piece {
        Piece::Segment(Segment { start, end }) => {
            let aside = distance * right_of(piece.tangent_at(0.0));
            Some(Piece::segment(start + aside, end + aside))
        }
        Piece::Arc(arc) => {
            let radius = arc.radius + distance * arc.sweep.signum();
            (radius > MIN_PIECE_LENGTH).then_some(Piece::Arc(Arc { radius, ..*arc }))
        }
    }
}

/// The corner between two straight pieces after both are moved to their right.
fn corner(into: &Piece, out: &Piece, distance: f64) -> Option<super::Point2> {
    let normals =
        straight(into).zip(straight(out)).map(|(into, out)| (right_of(into.tangent()), right_of(out.tangent())));
    let (before, after) = normals?;
    let share = 1.0 + before.dot(&after);
    // Two pieces that reverse the direction have no corner nearby.
    (share > 1e-3).then(|| out.start() + (before + after) * (distance / share))
}

fn straight(piece: &Piece) -> Option<Segment> {
    if let Piece::Segment(segment) = piece { Some(*segment) } else { None }
}

fn right_of(direction: Vector2) -> Vector2 {
    -perpendicular(direction)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]

    use std::f64::consts::PI;

    use super::*;
    use crate::geometry::{Path, Pose};

    #[test]
    fn sides_of_a_zigzag_are_parallel_to_its_runs_and_meet_at_their_corners() {
        let line = Path::from(Pose::default()).straight(0.3).turn(0.6).straight(0.3).turn(-1.0).straight(0.3);
        let strip = Strip::new(&line.open().unwrap(), 0.02).unwrap();
        for side in [strip.side(Side::Left), strip.side(Side::Right)] {
            assert_eq!(side.pieces().len(), 3);
            let turns: Vec<f64> = side.corners().iter().map(|corner| corner.turn).collect();
            assert!((turns[0] - 0.6).abs() < 1e-12 && (turns[1] + 1.0).abs() < 1e-12);
        }
        let outline = strip.outline().unwrap();
        assert!((outline.area() - 0.02 * 0.9).abs() < 1e-12, "what a corner adds on one side it takes on the other");
    }

    #[test]
    fn what_is_too_tight_is_refused_with_its_piece() {
        let bend = Path::from(Pose::default()).straight(0.1).arc(0.009, 1.0).open().unwrap();
        assert_eq!(Strip::new(&bend, 0.02).unwrap_err(), StripError::TooWide { piece: 1 });
        let short = Path::from(Pose::default()).straight(0.1).turn(1.5).straight(0.01).turn(1.5).straight(0.1);
        assert_eq!(Strip::new(&short.open().unwrap(), 0.03).unwrap_err(), StripError::TooWide { piece: 1 });
        let corner = Path::from(Pose::default()).straight(0.1).turn(1.0).arc(0.1, PI).open().unwrap();
        assert_eq!(Strip::new(&corner, 0.02).unwrap_err(), StripError::Corner { piece: 1 });
    }
}
