//! Joints between neighbouring pieces.

use std::f64::consts::PI;

use super::{Contour, Piece, Point2, Vector2};

/// Two tangents within this angle (rad) of opposite make a cusp.
const CUSP_TOLERANCE: f64 = 1e-9;

/// A joint that turns less than this (rad) is smooth: the direction of a piece carries the rounding of its coordinates.
const SMOOTH_TOLERANCE: f64 = 1e-6;

/// A point where the direction of a contour jumps.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Corner {
    /// Where along the contour (m).
    pub arc_length: f64,
    /// Where in the plane (m).
    pub point: Point2,
    /// How the direction of travel jumps (rad), in [−π, π], positive to the left. On a closed contour a positive turn is a
    /// convex corner, and its interior angle is π − turn.
    pub turn: f64,
}

impl Contour {
    /// The corners, in the order of travel; joints where the direction does not change are none.
    ///
    /// ```
    /// use vibrissa::geometry::{Point2, regular_polygon};
    /// let octagon = regular_polygon(Point2::new(0.32, 0.4), 0.3, 8, 0.0)?;
    /// let corners = octagon.corners();
    /// assert_eq!(corners.len(), 8);
    /// assert!(corners.iter().all(|corner| (corner.turn.to_degrees() - 45.0).abs() < 1e-9));
    /// # Ok::<(), vibrissa::geometry::ShapeError>(())
    /// ```
    #[must_use]
    pub fn corners(&self) -> Vec<Corner> {
        let joints = self.pieces.iter().zip(&self.starts).zip(&self.turns);
        joints
            .filter(|(_, turn)| turn.abs() > SMOOTH_TOLERANCE)
            .map(|((piece, &arc_length), &turn)| Corner { arc_length, point: piece.start(), turn })
            .collect()
    }

    /// Whether the contour is closed and its interior convex.
    #[must_use]
    pub fn is_convex(&self) -> bool {
        self.is_closed()
            && self.turns.iter().all(|&turn| turn > -SMOOTH_TOLERANCE)
            && self.pieces.iter().all(|piece| piece.curvature() >= 0.0)
    }
}

/// The jump of direction (rad, in [−π, π], positive to the left) from the end of `before` to the start of `after`.
/// `None` if `after` goes back over `before`.
///
/// At a cusp the tangents are opposite and do not tell a turn by π from one by −π. The curvatures do: with `before`
/// arriving along +x at the origin, the two lie at y = κ₁ x²/2 and y = −κ₂ x²/2, so the space between them is on the left
/// of `before`, and the turn π, where κ₁ + κ₂ is negative.
pub(super) fn turn(before: &Piece, after: &Piece) -> Option<f64> {
    let (incoming, outgoing) = (before.tangent_at(before.length()), after.tangent_at(0.0));
    let turn = incoming.perp(&outgoing).atan2(incoming.dot(&outgoing));
    if PI - turn.abs() > CUSP_TOLERANCE {
        return Some(turn);
    }
    let (kappa_1, kappa_2) = (before.curvature(), after.curvature());
    let opening = kappa_1 + kappa_2;
    if opening.abs() > CUSP_TOLERANCE * (kappa_1.abs() + kappa_2.abs()) { Some(-PI * opening.signum()) } else { None }
}

/// Whether a joint is a cusp so near, `to_joint` (m), to the nearest point of a point at `from_foot` that rounding decides
/// which of the two pieces was found to be nearest; they are on opposite sides of the point.
pub(super) fn is_ambiguous_at_cusp(turn: f64, to_joint: f64, from_foot: Vector2) -> bool {
    // The distances to the two pieces differ by the square of this times their curvatures.
    const REACH: f64 = 1e-6;
    // Within a spike, points are much nearer to its sides than its sides are to its tip.
    PI - turn.abs() <= CUSP_TOLERANCE && to_joint < REACH && from_foot.norm() > to_joint
}

/// The side, +1 right or −1 left, of a joint on which the point at `from_joint` lies, given that the joint is its nearest
/// point.
pub(super) fn side(turn: f64, incoming: Vector2, outgoing: Vector2, from_joint: Vector2) -> f64 {
    // The points nearest to a joint fill the wedge between its two normals, which opens away from the turn. Where the turn
    // is slight the wedge is thin and rounding may put a point of either side into it: there the tangent decides.
    const SLIGHT: f64 = 1e-3;
    if turn.abs() > SLIGHT { turn.signum() } else { right_of(incoming + outgoing, from_joint) }
}

/// +1 if `offset` points to the right of `direction` or along it, −1 if to its left.
pub(super) fn right_of(direction: Vector2, offset: Vector2) -> f64 {
    if direction.perp(&offset) > 0.0 { -1.0 } else { 1.0 }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]

    use super::*;

    #[test]
    fn the_curvatures_tell_a_convex_cusp_from_a_reflex_one() {
        // Arriving at the origin along +x; leaving along −x by an arc that bends up, then by one that bends down.
        let arriving = Piece::segment(Point2::new(-1.0, 0.0), Point2::origin());
        let above = Piece::arc(Point2::new(0.0, 1.0), 1.0, -0.5 * PI, -1.0);
        let below = Piece::arc(Point2::new(0.0, -1.0), 1.0, 0.5 * PI, 1.0);
        assert!((turn(&arriving, &above).unwrap() - PI).abs() < 1e-15);
        assert!((turn(&arriving, &below).unwrap() + PI).abs() < 1e-15);
    }

    #[test]
    fn going_back_over_the_same_piece_has_no_turn() {
        let there = Piece::arc(Point2::origin(), 1.0, 0.3, 1.0);
        assert_eq!(turn(&there, &there.reversed()), None);
    }
}
