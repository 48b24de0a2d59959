//! Polygons.

use super::ShapeError;
use super::error::finite_point;
use crate::geometry::{Contour, MIN_PIECE_LENGTH, Piece, Point2};

/// The polygon with these corners (m), in either direction. The first corner is not repeated.
///
/// ```
/// use vibrissa_world::geometry::{Point2, ShapeError, polygon};
/// let prism = polygon(&[Point2::new(0.15, 0.2), Point2::new(0.0206, 0.6830), Point2::new(0.5036, 0.5536)])?;
/// assert!(prism.is_convex());
/// let line = polygon(&[Point2::new(0.0, 0.0), Point2::new(1.0, 0.0)]);
/// assert_eq!(line.err(), Some(ShapeError::TooFewSides { sides: 2 }));
/// # Ok::<(), ShapeError>(())
/// ```
///
/// # Errors
/// If there are fewer than three corners, a number is not finite, two consecutive corners are the same, or sides cross or
/// touch.
pub fn polygon(corners: &[Point2]) -> Result<Contour, ShapeError> {
    let sides = corners.len();
    if sides < 3 {
        return Err(ShapeError::TooFewSides { sides });
    }
    for &corner in corners {
        finite_point("corner", corner)?;
    }
    let mut pieces = Vec::with_capacity(sides);
    for from in 0..sides {
        let to = (from + 1) % sides;
        if (corners[to] - corners[from]).norm() < MIN_PIECE_LENGTH {
            return Err(ShapeError::ZeroEdge { from, to });
        }
        pieces.push(Piece::segment(corners[from], corners[to]));
    }
    Ok(Contour::closed(pieces)?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polygons_that_are_none_are_refused_with_the_cause() {
        let (a, b, c) = (Point2::origin(), Point2::new(1.0, 0.0), Point2::new(0.0, 1.0));
        assert_eq!(polygon(&[a, b, c, a]).err(), Some(ShapeError::ZeroEdge { from: 3, to: 0 }));
        let nowhere = polygon(&[a, b, Point2::new(f64::INFINITY, 0.0)]).err();
        assert_eq!(nowhere, Some(ShapeError::NotFinite { what: "corner", value: f64::INFINITY }));
        assert!(matches!(polygon(&[a, b, Point2::new(2.0, 0.0)]).err(), Some(ShapeError::Contour(_))));
    }
}
