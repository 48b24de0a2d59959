//! Sampled points of a contour.

use super::{Contour, Point2, Vector2};

/// A point of a contour.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct ContourPoint {
    /// The position (m).
    pub point: Point2,
    /// The tangent, a unit vector in the direction of travel.
    pub tangent: Vector2,
    /// The arc length along the contour (m).
    pub arc_length: f64,
}

impl Contour {
    /// Points at equal steps of arc length, starting at the start. The step is the largest uniform one that does not
    /// exceed `spacing` (m). An open contour's last point is its end. A closed contour's start is not repeated. A
    /// spacing that is not a positive number gives one step.
    ///
    /// ```
    /// use vibrissa_world::geometry::{Point2, circle};
    /// let points = circle(Point2::origin(), 0.1)?.sample(0.01);
    /// assert_eq!(points.len(), 63);
    /// assert!(points.iter().all(|sample| (sample.point.coords.norm() - 0.1).abs() < 1e-15));
    /// # Ok::<(), vibrissa_world::geometry::ShapeError>(())
    /// ```
    #[must_use]
    pub fn sample(&self, spacing: f64) -> Vec<ContourPoint> {
        // A length that is a multiple of the spacing up to rounding has exactly that number of steps.
        let steps = if spacing > 0.0 { (self.length / spacing * (1.0 - 1e-12)).ceil().max(1.0) } else { 1.0 };
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a whole number of at least 1")]
        let count = steps as usize + usize::from(!self.closed);
        let mut index = 0;
        (0..count)
            .map(|k| {
                let arc_length = self.length * (k as f64 / steps);
                while self.starts.get(index + 1).is_some_and(|&next| next <= arc_length) {
                    index += 1;
                }
                let (piece, along) = (&self.pieces[index], arc_length - self.starts[index]);
                ContourPoint { point: piece.point_at(along), tangent: piece.tangent_at(along), arc_length }
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]

    use crate::geometry::{Contour, Piece, Point2};

    #[test]
    fn an_open_contour_is_sampled_from_end_to_end() {
        let stick = Contour::open(vec![Piece::segment(Point2::origin(), Point2::new(1.0, 0.0))]).unwrap();
        let points = stick.sample(0.3);
        assert_eq!(points.len(), 5);
        assert_eq!(points[4].point, Point2::new(1.0, 0.0));
        assert_eq!(stick.sample(1.0 / 49.0).len(), 50);
        assert_eq!(stick.sample(f64::NAN).len(), 2);
        assert_eq!(stick.sample(0.0).len(), 2);
    }
}
