//! Overlap of two contours.

use rstar::AABB;

use super::distance::Leaf;
use super::simple::{grown, meeting};
use super::{Contour, JOIN_TOLERANCE, Piece, Segment, TreePoint};

impl Contour {
    /// True if two contours cross or touch, or if one lies inside of the other.
    ///
    /// ```
    /// use vibrissa_world::geometry::{Point2, circle};
    /// let disk = circle(Point2::origin(), 0.1)?;
    /// assert!(disk.overlaps(&circle(Point2::origin(), 0.02)?));
    /// assert!(disk.overlaps(&circle(Point2::new(0.2, 0.0), 0.1)?));
    /// assert!(!disk.overlaps(&circle(Point2::new(0.21, 0.0), 0.1)?));
    /// # Ok::<(), vibrissa_world::geometry::ShapeError>(())
    /// ```
    #[must_use]
    pub fn overlaps(&self, other: &Self) -> bool {
        self.meets(other, JOIN_TOLERANCE, &mut 0, usize::MAX).unwrap_or(true)
    }

    /// True if two contours are within a `tolerance` (m) of each other, or if one lies inside of the other. The number
    /// of tests is added to `work`. `None` if it exceeds `most`.
    pub(super) fn meets(&self, other: &Self, tolerance: f64, work: &mut usize, most: usize) -> Option<bool> {
        let frame = grown(&self.bounding_box(), tolerance);
        // Pieces need no test if the contours are far apart as a whole.
        if other.near(frame).next().is_none() && self.near(grown(&other.bounding_box(), tolerance)).next().is_none() {
            return Some(false);
        }
        for piece in &self.pieces {
            // The search for pieces counts as work.
            *work += 1;
            for leaf in other.near(grown(&piece.bounding_box(), tolerance)) {
                *work += 1;
                if meeting(piece, &leaf.piece, &[], tolerance).is_some() {
                    return Some(true);
                }
            }
            if *work > most {
                return None;
            }
        }
        Some(self.contains(other.point_at(0.0)) || other.contains(self.point_at(0.0)))
    }

    /// The pieces that may be near a line: their boxes intersect its box, enlarged by [`JOIN_TOLERANCE`].
    pub fn pieces_near(&self, line: &Segment) -> impl Iterator<Item = &Piece> {
        self.pieces_within(line, 0.0)
    }

    /// The pieces that may be within a `distance` (m) of a line.
    pub fn pieces_within(&self, line: &Segment, distance: f64) -> impl Iterator<Item = &Piece> {
        self.near(grown(&line.bounding_box(), distance + JOIN_TOLERANCE)).map(|leaf| &leaf.piece)
    }

    /// The pieces whose boxes intersect a box.
    pub(super) fn near(&self, frame: AABB<TreePoint>) -> impl Iterator<Item = &Leaf> {
        self.tree.locate_in_envelope_intersecting(frame)
    }
}
