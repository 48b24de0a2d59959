//! Vertices between consecutive pieces: corners and cusps.

use std::f64::consts::PI;

use vibrissa_runtime::math;

use super::{Contour, Piece, Point2, Vector2};

/// Two tangents are a cusp if they are opposite within this angle (rad).
const CUSP_TOLERANCE: f64 = 1e-9;

/// A vertex with a smaller turn (rad) is smooth, because tangents have the rounding errors of coordinates.
const SMOOTH_TOLERANCE: f64 = 1e-6;

/// A discontinuity of a contour's direction.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Corner {
    /// The arc length along the contour (m).
    pub arc_length: f64,
    /// The position (m).
    pub point: Point2,
    /// The change of direction (rad) in [−π, π], positive to the left. On a closed contour, a positive turn is a convex
    /// corner with the interior angle π − turn.
    pub turn: f64,
}

impl Contour {
    /// The corners in the order of travel, without smooth vertices.
    ///
    /// ```
    /// use vibrissa_world::geometry::{Point2, regular_polygon};
    /// let octagon = regular_polygon(Point2::new(0.32, 0.4), 0.3, 8, 0.0)?;
    /// let corners = octagon.corners();
    /// assert_eq!(corners.len(), 8);
    /// assert!(corners.iter().all(|corner| (corner.turn.to_degrees() - 45.0).abs() < 1e-9));
    /// # Ok::<(), vibrissa_world::geometry::ShapeError>(())
    /// ```
    #[must_use]
    pub fn corners(&self) -> Vec<Corner> {
        let vertices = self.pieces.iter().zip(&self.starts).zip(&self.turns);
        vertices
            .filter(|(_, turn)| turn.abs() > SMOOTH_TOLERANCE)
            .map(|((piece, &arc_length), &turn)| Corner { arc_length, point: piece.start(), turn })
            .collect()
    }

    /// True if the contour is closed and its interior convex.
    #[must_use]
    pub fn is_convex(&self) -> bool {
        self.is_closed()
            && self.turns.iter().all(|&turn| turn > -SMOOTH_TOLERANCE)
            && self.pieces.iter().all(|piece| piece.curvature() >= 0.0)
    }
}

/// The change of direction (rad, in [−π, π], positive to the left) from the end of `before` to the start of `after`.
/// `None` if `after` retraces `before`.
///
/// At a cusp the tangents are opposite, so that they do not distinguish the turns π and −π. The curvatures do. With
/// `before` arriving along +x at the origin, the pieces are y = κ₁ x²/2 and y = −κ₂ x²/2. The space between them is on
/// the left of `before`, and the turn is π, if κ₁ + κ₂ is negative.
pub(super) fn turn(before: &Piece, after: &Piece) -> Option<f64> {
    let (incoming, outgoing) = (before.tangent_at(before.length()), after.tangent_at(0.0));
    let turn = math::atan2(incoming.perp(&outgoing), incoming.dot(&outgoing));
    if PI - turn.abs() > CUSP_TOLERANCE {
        return Some(turn);
    }
    let (kappa_1, kappa_2) = (before.curvature(), after.curvature());
    let opening = kappa_1 + kappa_2;
    if opening.abs() > CUSP_TOLERANCE * (kappa_1.abs() + kappa_2.abs()) { Some(-PI * opening.signum()) } else { None }
}

/// True if rounding decides which of the two pieces at a cusp is nearest to a point. Both pieces are on opposite sides
/// of the point. `to_vertex` is the distance (m) from the nearest point to the vertex, `from_nearest` the vector from the
/// nearest point.
pub(super) fn is_ambiguous_at_cusp(turn: f64, to_vertex: f64, from_nearest: Vector2) -> bool {
    // The distances to the two pieces differ by the square of this times their curvatures.
    const REACH: f64 = 1e-6;
    // Within a spike, points are much nearer to its sides than its sides are to its tip.
    PI - turn.abs() <= CUSP_TOLERANCE && to_vertex < REACH && from_nearest.norm() > to_vertex
}

/// The side of a vertex, +1 right or −1 left, on which the point at `from_vertex` lies. The vertex must be its nearest
/// point.
pub(super) fn side(turn: f64, incoming: Vector2, outgoing: Vector2, from_vertex: Vector2) -> f64 {
    // The points nearest to a vertex fill the wedge between its two normals, on the outside of the turn. The wedge of a
    // slight turn is thin, and rounding may place a point of either side in it. There, the tangent decides.
    const SLIGHT: f64 = 1e-3;
    if turn.abs() > SLIGHT { turn.signum() } else { right_of(incoming + outgoing, from_vertex) }
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
        // Arriving at the origin along +x, then leaving along −x by an arc that bends up or down.
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
