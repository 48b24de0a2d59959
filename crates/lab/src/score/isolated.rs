//! Outlines that a rig can touch all around, which needs no search.

use std::f64::consts::TAU;

use vibrissa_world::geometry::{Contour, Piece, Vector2, rotate};

use super::reach::STRAIGHT_HEADINGS;

/// The distance (m) from the limit of a condition within which rounding could decide it.
const ROUNDING: f64 = 1e-6;

/// True if the outline of an object is convex. The object is on the left of its outline.
pub(super) fn is_convex(contour: &Contour) -> bool {
    let pieces = contour.pieces();
    let turns_left = |piece: &Piece| match piece {
        Piece::Segment(_) => true,
        Piece::Arc(arc) => arc.sweep > 0.0,
    };
    let meets_left = |before: &Piece, after: &Piece| {
        let (before, after) = (before.tangent_at(before.length()), after.tangent_at(0.0));
        before.perp(&after) > -ROUNDING && before.dot(&after) > ROUNDING - 1.0
    };
    contour.is_closed()
        && contour.area() > 0.0
        && pieces.iter().all(turns_left)
        && pieces.iter().zip(pieces.iter().cycle().skip(1)).all(|(before, after)| meets_left(before, after))
}

/// True if a platform can lie beyond a straight wall with the base of a whisker at this `distance` (m) from the wall, at one of the
/// headings of [`STRAIGHT_HEADINGS`]. `mounts` are the corners of the footprint relative to each base (m, body frame).
pub(super) fn lies_beyond_wall(mounts: &[[Vector2; 4]], distance: f64) -> bool {
    let is_beyond = |corners: &[Vector2; 4], heading: f64| {
        corners.iter().all(|&corner| rotate(corner, heading).x > ROUNDING - distance)
    };
    let headings = || (0..STRAIGHT_HEADINGS).map(|index| TAU * f64::from(index) / f64::from(STRAIGHT_HEADINGS));
    mounts.iter().any(|corners| headings().any(|heading| is_beyond(corners, heading)))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]
    use super::*;
    use vibrissa_world::geometry::{Point2, circle, polygon, regular_polygon, rounded_rectangle};

    #[test]
    fn only_outlines_without_a_recess_are_convex() {
        let centre = Point2::new(0.3, -0.2);
        assert!(is_convex(&circle(centre, 0.1).unwrap()));
        assert!(is_convex(&regular_polygon(centre, 0.1, 7, 0.2).unwrap()));
        assert!(is_convex(&rounded_rectangle(centre, 0.3, 0.2, 0.05, 0.1).unwrap()));
        let arrow = [(0.0, 0.0), (0.2, 0.0), (0.2, 0.2), (0.1, 0.05)].map(|(x, y)| Point2::new(x, y));
        assert!(!is_convex(&polygon(&arrow).unwrap()));
    }

    #[test]
    fn a_footprint_lies_beyond_a_wall_if_its_base_is_far_enough_from_its_side() {
        // The base is 20 mm inside the left side of a square.
        let square = [(-0.1, -0.1), (0.1, -0.1), (0.1, 0.02), (-0.1, 0.02)].map(|(x, y)| Vector2::new(x, y));
        assert!(lies_beyond_wall(&[square], 0.021) && !lies_beyond_wall(&[square], 0.019));
    }
}
