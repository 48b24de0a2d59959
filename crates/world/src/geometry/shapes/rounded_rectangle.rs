//! Rectangles with rounded corners.

use std::f64::consts::FRAC_PI_2;

use super::ShapeError;
use super::error::{finite, finite_point, positive};
use crate::geometry::{Contour, MIN_PIECE_LENGTH, Piece, Point2, Pose, Vector2};

/// A rectangle with rounded corners, from its centre (m), its extents along its own x and y axes (m), the corner radius
/// (m, 0 for sharp corners), and the heading of its x axis (rad).
///
/// ```
/// use std::f64::consts::PI;
/// use vibrissa_world::geometry::{Point2, rounded_rectangle};
/// let outline = rounded_rectangle(Point2::new(0.375, 0.8), 0.52, 1.02, 0.11, 0.0)?;
/// assert!((outline.area() - (0.52 * 1.02 - (4.0 - PI) * 0.11 * 0.11)).abs() < 1e-14);
/// # Ok::<(), vibrissa_world::geometry::ShapeError>(())
/// ```
///
/// # Errors
/// If a number is not finite, a side not positive, or the radius negative or more than half a side.
pub fn rounded_rectangle(
    centre: Point2,
    width: f64,
    height: f64,
    corner_radius: f64,
    heading: f64,
) -> Result<Contour, ShapeError> {
    finite_point("centre", centre)?;
    positive("width", width)?;
    positive("height", height)?;
    finite("corner radius", corner_radius)?;
    finite("heading", heading)?;
    let limit = 0.5 * width.min(height);
    if !(0.0..=limit).contains(&corner_radius) {
        return Err(ShapeError::CornerRadius { radius: corner_radius, limit });
    }

    // The centres of the corner arcs, from the lower right counter-clockwise.
    let (x, y) = (0.5 * width - corner_radius, 0.5 * height - corner_radius);
    let centres = [Point2::new(x, -y), Point2::new(x, y), Point2::new(-x, y), Point2::new(-x, -y)];
    let outward = [Vector2::x(), Vector2::y(), -Vector2::x(), -Vector2::y()];
    let pose = Pose { position: centre, heading };
    let mut pieces = Vec::with_capacity(8);
    for side in 0..4_u8 {
        let (from, to) = (usize::from(side), usize::from((side + 1) % 4));
        let inset = outward[from] * corner_radius;
        pieces.push(Piece::segment(centres[from] + inset, centres[to] + inset));
        pieces.push(Piece::arc(centres[to], corner_radius, f64::from(side) * FRAC_PI_2, FRAC_PI_2));
    }
    let pieces = pieces.iter().filter(|piece| piece.length() >= MIN_PIECE_LENGTH).map(|piece| piece.transformed(&pose));
    Ok(Contour::closed(pieces.collect())?)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]

    use std::f64::consts::PI;

    use super::*;

    #[test]
    fn the_radius_may_vanish_or_take_up_a_side_or_both() {
        let area = |radius| rounded_rectangle(Point2::new(3.0, 1.0), 0.4, 0.2, radius, 0.7).unwrap().area();
        assert!((area(0.0) - 0.08).abs() < 1e-14);
        assert!((area(0.1) - (0.04 + 0.01 * PI)).abs() < 1e-14);
        let disk = rounded_rectangle(Point2::origin(), 0.2, 0.2, 0.1, 0.7).unwrap();
        assert!((disk.length() - 0.2 * PI).abs() < 1e-14);
    }

    #[test]
    fn a_radius_too_large_is_refused_with_the_limit() {
        let error = rounded_rectangle(Point2::origin(), 0.4, 0.2, 0.11, 0.0).err();
        assert_eq!(error, Some(ShapeError::CornerRadius { radius: 0.11, limit: 0.1 }));
    }
}
