//! Circles.

use std::f64::consts::TAU;

use super::ShapeError;
use super::error::{finite_point, positive};
use crate::geometry::{Contour, Piece, Point2};

/// A circle about `centre` (m) with this `radius` (m), starting at its rightmost point.
///
/// ```
/// use vibrissa_world::geometry::{Point2, circle};
/// let disk = circle(Point2::new(0.4, 0.4), 0.3)?;
/// assert!((disk.length() - 0.6 * std::f64::consts::PI).abs() < 1e-15);
/// assert!(circle(Point2::origin(), -0.3).is_err());
/// # Ok::<(), vibrissa_world::geometry::ShapeError>(())
/// ```
///
/// # Errors
/// If a number is not finite or the radius not positive.
pub fn circle(centre: Point2, radius: f64) -> Result<Contour, ShapeError> {
    finite_point("centre", centre)?;
    positive("radius", radius)?;
    Ok(Contour::closed(vec![Piece::arc(centre, radius, 0.0, TAU)])?)
}
