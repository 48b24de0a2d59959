//! Regular polygons.

use std::f64::consts::TAU;

use super::error::{finite, finite_point, positive};
use super::{ShapeError, polygon};
use crate::geometry::{Contour, Point2, unit};

/// A regular polygon, from its centre (m), the distance of its corners from it (m), the number of its sides, and the
/// direction from the centre to the first corner (rad).
///
/// ```
/// use vibrissa_world::geometry::{Point2, regular_polygon};
/// let hexagon = regular_polygon(Point2::origin(), 0.1, 6, 0.0)?;
/// assert!((hexagon.length() - 0.6).abs() < 1e-15);
/// # Ok::<(), vibrissa_world::geometry::ShapeError>(())
/// ```
///
/// # Errors
/// If there are fewer than three sides, a number is not finite, or the radius not positive or too small for so many sides.
pub fn regular_polygon(
    centre: Point2,
    circumradius: f64,
    sides: usize,
    heading_of_first_vertex: f64,
) -> Result<Contour, ShapeError> {
    finite_point("centre", centre)?;
    positive("circumradius", circumradius)?;
    finite("heading of the first corner", heading_of_first_vertex)?;
    let step = TAU / sides as f64;
    let corner = |k| centre + circumradius * unit(heading_of_first_vertex + step * k as f64);
    polygon(&(0..sides).map(corner).collect::<Vec<_>>())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_sides_make_no_polygon() {
        assert_eq!(regular_polygon(Point2::origin(), 1.0, 2, 0.0).err(), Some(ShapeError::TooFewSides { sides: 2 }));
    }
}
