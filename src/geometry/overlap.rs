//! Whether two contours overlap.

use super::Contour;
use super::simple::{around, meeting};

impl Contour {
    /// Whether two contours cross or touch, or one lies inside the other.
    ///
    /// ```
    /// use vibrissa::geometry::{Point2, circle};
    /// let disk = circle(Point2::origin(), 0.1)?;
    /// assert!(disk.overlaps(&circle(Point2::origin(), 0.02)?));
    /// assert!(disk.overlaps(&circle(Point2::new(0.2, 0.0), 0.1)?));
    /// assert!(!disk.overlaps(&circle(Point2::new(0.21, 0.0), 0.1)?));
    /// # Ok::<(), vibrissa::geometry::ShapeError>(())
    /// ```
    #[must_use]
    pub fn overlaps(&self, other: &Self) -> bool {
        if !self.bounding_box().meets(&other.bounding_box()) {
            return false;
        }
        let meets = self.pieces.iter().any(|piece| {
            let mut near = other.tree.locate_in_envelope_intersecting(around(piece));
            near.any(|leaf| meeting(piece, &leaf.piece, &[]).is_some())
        });
        meets || self.contains(other.point_at(0.0)) || other.contains(self.point_at(0.0))
    }
}
