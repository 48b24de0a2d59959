//! Contours: contiguous pieces.

use std::f64::consts::TAU;

use rstar::RTree;

use super::distance::Leaf;
use super::{BoundingBox, ContourError, Piece, Point2, Pose, Vector2, corner, plane_point, simple};

/// The largest distance (m) between the end of a piece and the start of the next.
pub const JOIN_TOLERANCE: f64 = 1e-9;

/// The smallest length (m) of a piece. A shorter piece cannot be distinguished from a gap.
pub(crate) const MIN_PIECE_LENGTH: f64 = 1e-8;

/// A curve of contiguous segments and circular arcs. It neither crosses nor touches itself.
///
/// A closed contour is counter-clockwise: its interior is on the left.
///
/// ```
/// use std::f64::consts::{FRAC_PI_2, PI};
/// use vibrissa_world::geometry::{Contour, Piece, Point2};
/// let half_disk = Contour::closed(vec![
///     Piece::segment(Point2::new(0.0, -0.1), Point2::new(0.0, 0.1)),
///     Piece::arc(Point2::origin(), 0.1, FRAC_PI_2, -PI),
/// ])?;
/// assert!((half_disk.length() - 0.1 * (2.0 + PI)).abs() < 1e-15);
/// assert!((half_disk.area() - 0.005 * PI).abs() < 1e-15);
/// # Ok::<(), vibrissa_world::geometry::ContourError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Contour {
    pub(super) pieces: Vec<Piece>,
    /// Arc length at the start of each piece.
    pub(super) starts: Vec<f64>,
    /// Turn at the start of each piece, 0 at the free start of an open contour.
    pub(super) turns: Vec<f64>,
    pub(super) length: f64,
    pub(super) closed: bool,
    pub(super) tree: RTree<Leaf>,
}

impl Contour {
    /// Creates a closed contour. Clockwise pieces are reversed, together with their order.
    ///
    /// # Errors
    /// If there is no piece, a piece is invalid, consecutive pieces (including the last and the first) do not join
    /// within [`JOIN_TOLERANCE`], or the contour meets itself.
    pub fn closed(pieces: Vec<Piece>) -> Result<Self, ContourError> {
        Self::build(pieces, true)
    }

    /// Creates an open contour with the given direction of travel.
    ///
    /// # Errors
    /// If there is no piece, a piece is invalid, consecutive pieces do not join within [`JOIN_TOLERANCE`], or the
    /// contour meets itself.
    pub fn open(pieces: Vec<Piece>) -> Result<Self, ContourError> {
        Self::build(pieces, false)
    }

    /// The pieces in the order of travel.
    #[must_use]
    pub fn pieces(&self) -> &[Piece] {
        &self.pieces
    }

    /// True if the contour ends at its start and has an interior.
    #[must_use]
    pub fn is_closed(&self) -> bool {
        self.closed
    }

    /// Length (m).
    #[must_use]
    pub fn length(&self) -> f64 {
        self.length
    }

    /// The point at arc length `s` (m) from the start. On a closed contour `s` is periodic, on an open one it is
    /// clamped.
    #[must_use]
    pub fn point_at(&self, s: f64) -> Point2 {
        let (index, along) = self.locate(s);
        self.pieces[index].point_at(along)
    }

    /// The tangent at arc length `s` (m), a unit vector in the direction of travel. `s` counts as in
    /// [`point_at`](Self::point_at). At a corner it is the tangent after the corner.
    #[must_use]
    pub fn tangent_at(&self, s: f64) -> Vector2 {
        let (index, along) = self.locate(s);
        self.pieces[index].tangent_at(along)
    }

    /// The bounding box.
    #[must_use]
    pub fn bounding_box(&self) -> BoundingBox {
        let envelope = self.tree.root().envelope();
        BoundingBox::around(plane_point(envelope.lower()), plane_point(envelope.upper()))
    }

    /// The enclosed area (m²), 0 for an open contour.
    #[must_use]
    pub fn area(&self) -> f64 {
        if self.closed { signed_area(&self.pieces) } else { 0.0 }
    }

    /// Transforms the contour from the frame of `pose` to world coordinates.
    #[must_use]
    pub fn transformed(&self, pose: &Pose) -> Self {
        let pieces: Vec<_> = self.pieces.iter().map(|piece| piece.transformed(pose)).collect();
        Self { tree: Leaf::tree(&pieces), pieces, starts: self.starts.clone(), turns: self.turns.clone(), ..*self }
    }

    /// The piece at arc length `s`, and the arc length from its start.
    fn locate(&self, s: f64) -> (usize, f64) {
        let s = if self.closed { s.rem_euclid(self.length) } else { s };
        let index = self.starts.partition_point(|&start| start <= s).saturating_sub(1);
        (index, s - self.starts[index])
    }

    fn build(mut pieces: Vec<Piece>, closed: bool) -> Result<Self, ContourError> {
        check_pieces(&pieces)?;
        check_vertices(&pieces, closed)?;
        let mut turns = turns(&pieces, closed)?;
        let mut tree = Leaf::tree(&pieces);
        simple::check(&pieces, closed, &tree)?;
        if closed && signed_area(&pieces) < 0.0 {
            pieces.reverse();
            for piece in &mut pieces {
                *piece = piece.reversed();
            }
            // The vertex at the start of the first piece stays first. The order of the others is reversed.
            turns[1..].reverse();
            for turn in &mut turns {
                *turn = -*turn;
            }
            tree = Leaf::tree(&pieces);
        }
        let mut length = 0.0;
        let starts = pieces
            .iter()
            .map(|piece| {
                let start = length;
                length += piece.length();
                start
            })
            .collect();
        Ok(Self { pieces, starts, turns, length, closed, tree })
    }
}

fn check_pieces(pieces: &[Piece]) -> Result<(), ContourError> {
    if pieces.is_empty() {
        return Err(ContourError::Empty);
    }
    for (index, piece) in pieces.iter().enumerate() {
        let numbers = match piece {
            Piece::Segment(segment) => [segment.start.x, segment.start.y, segment.end.x, segment.end.y, 0.0],
            Piece::Arc(arc) => [arc.centre.x, arc.centre.y, arc.radius, arc.start_angle, arc.sweep],
        };
        if !numbers.iter().all(|number| number.is_finite()) {
            return Err(ContourError::NotFinite { piece: index });
        }
        if let Piece::Arc(arc) = piece {
            if arc.radius <= 0.0 {
                return Err(ContourError::Radius { piece: index, radius: arc.radius });
            }
            if arc.sweep.abs() > TAU {
                return Err(ContourError::Sweep { piece: index, sweep: arc.sweep });
            }
        }
        if piece.length() < MIN_PIECE_LENGTH {
            return Err(ContourError::TooShort { piece: index, length: piece.length() });
        }
    }
    Ok(())
}

fn check_vertices(pieces: &[Piece], closed: bool) -> Result<(), ContourError> {
    let last = pieces.len() - 1;
    for index in 0..=last {
        let next = (index + 1) % pieces.len();
        let distance = (pieces[next].start() - pieces[index].end()).norm();
        if index == last && !closed {
            if distance <= JOIN_TOLERANCE {
                return Err(ContourError::EndsMeet);
            }
        } else if distance > JOIN_TOLERANCE {
            return Err(ContourError::Gap { piece: index, next, distance });
        }
    }
    Ok(())
}

fn turns(pieces: &[Piece], closed: bool) -> Result<Vec<f64>, ContourError> {
    let last = pieces.len() - 1;
    (0..=last)
        .map(|index| {
            if index == 0 && !closed {
                return Ok(0.0);
            }
            let before = index.checked_sub(1).unwrap_or(last);
            corner::turn(&pieces[before], &pieces[index]).ok_or_else(|| ContourError::SelfIntersection {
                first: before.min(index),
                second: before.max(index),
                at: pieces[index].start(),
            })
        })
        .collect()
}

/// The enclosed area (m²) of a closed chain, positive counter-clockwise.
fn signed_area(pieces: &[Piece]) -> f64 {
    // The origin is a point of the chain, so that a small distant chain loses no digits.
    let origin = pieces[0].start();
    pieces.iter().map(|piece| piece.swept_area(origin)).sum()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]

    use std::f64::consts::PI;

    use super::*;

    fn corners(points: &[(f64, f64)]) -> Vec<Piece> {
        let points: Vec<_> = points.iter().map(|&(x, y)| Point2::new(x, y)).collect();
        (0..points.len()).map(|i| Piece::segment(points[i], points[(i + 1) % points.len()])).collect()
    }

    #[test]
    fn a_clockwise_chain_is_turned_round() {
        let contour = Contour::closed(corners(&[(0.0, 0.0), (0.0, 2.0), (3.0, 2.0), (3.0, 0.0)])).unwrap();
        assert!((contour.area() - 6.0).abs() < 1e-15);
        assert!(contour.corners().iter().all(|corner| (corner.turn - 0.5 * PI).abs() < 1e-15));
        assert!(contour.is_convex());
    }

    #[test]
    fn turning_a_chain_round_keeps_each_turn_at_its_corner() {
        let contour = Contour::closed(corners(&[(0.0, 0.0), (1.0, 0.3), (2.0, 0.0), (1.0, 3.0)])).unwrap();
        let mirrored = Contour::closed(corners(&[(0.0, 0.0), (1.0, 3.0), (2.0, 0.0), (1.0, 0.3)])).unwrap();
        for corner in contour.corners() {
            let twin = mirrored.corners().into_iter().find(|twin| (twin.point - corner.point).norm() < 1e-15).unwrap();
            assert!((twin.turn - corner.turn).abs() < 1e-15);
        }
        assert!(!contour.is_convex());
    }

    #[test]
    fn chains_that_are_no_contour_are_refused() {
        let gap = vec![
            Piece::segment(Point2::origin(), Point2::new(1.0, 0.0)),
            Piece::segment(Point2::new(1.0, 1e-6), Point2::new(2.0, 0.0)),
        ];
        assert!(matches!(Contour::open(gap), Err(ContourError::Gap { piece: 0, next: 1, .. })));
        let unclosed = vec![Piece::arc(Point2::origin(), 1.0, 0.0, PI)];
        assert!(matches!(Contour::closed(unclosed), Err(ContourError::Gap { piece: 0, next: 0, .. })));
        let circle = Piece::arc(Point2::origin(), 1.0, 0.0, TAU);
        assert_eq!(Contour::open(vec![circle]).unwrap_err(), ContourError::EndsMeet);
        assert_eq!(Contour::closed(vec![]).unwrap_err(), ContourError::Empty);
        let negative = vec![Piece::arc(Point2::origin(), -1.0, 0.0, TAU)];
        assert_eq!(Contour::closed(negative).unwrap_err(), ContourError::Radius { piece: 0, radius: -1.0 });
        let twice = vec![Piece::arc(Point2::origin(), 1.0, 0.0, 2.0 * TAU)];
        assert!(matches!(Contour::closed(twice), Err(ContourError::Sweep { piece: 0, .. })));
        let nowhere = vec![Piece::arc(Point2::new(f64::NAN, 0.0), 1.0, 0.0, TAU)];
        assert_eq!(Contour::closed(nowhere).unwrap_err(), ContourError::NotFinite { piece: 0 });
        let dot = vec![Piece::segment(Point2::origin(), Point2::origin())];
        assert_eq!(Contour::open(dot).unwrap_err(), ContourError::TooShort { piece: 0, length: 0.0 });
    }

    #[test]
    fn arc_length_counts_round_a_closed_contour_and_stops_at_the_ends_of_an_open_one() {
        let square = Contour::closed(corners(&[(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)])).unwrap();
        assert!((square.point_at(5.5) - square.point_at(1.5)).norm() < 1e-15);
        assert!((square.point_at(-0.5) - Point2::new(0.0, 0.5)).norm() < 1e-15);
        let stick = Contour::open(vec![Piece::segment(Point2::origin(), Point2::new(2.0, 0.0))]).unwrap();
        assert_eq!(stick.point_at(7.0), Point2::new(2.0, 0.0));
        assert_eq!(stick.point_at(-7.0), Point2::origin());
        assert!(!stick.is_convex() && stick.area().abs() < f64::EPSILON);
    }
}
