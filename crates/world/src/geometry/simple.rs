//! The test for self-intersections of a contour.

use rstar::{AABB, RTree};

use super::distance::Leaf;
use super::{Arc, BoundingBox, ContourError, JOIN_TOLERANCE, Piece, Point2, Segment, TreePoint, perpendicular};

/// The largest number of pairs of pieces with overlapping boxes, which take a second or two. Only many long diagonal
/// pieces reach it.
pub(super) const MAX_PAIRS: usize = 2_000_000;

/// Checks that the pieces of a chain meet only at their vertices. Neighbours that retrace each other from a vertex are
/// found by [`turn`](super::corner::turn).
pub(super) fn check(pieces: &[Piece], closed: bool, tree: &RTree<Leaf>) -> Result<(), ContourError> {
    let mut pairs = 0;
    for (first, piece) in pieces.iter().enumerate() {
        for leaf in tree.locate_in_envelope_intersecting(grown(&piece.bounding_box(), JOIN_TOLERANCE)) {
            pairs += 1;
            if pairs > MAX_PAIRS {
                return Err(ContourError::Intricate { limit: MAX_PAIRS });
            }
            let second = leaf.index;
            if second <= first {
                continue;
            }
            let vertices = shared_vertices(pieces, closed, first, second);
            if let Some(at) = meeting(piece, &pieces[second], &vertices, JOIN_TOLERANCE) {
                return Err(ContourError::SelfIntersection { first, second, at });
            }
        }
    }
    Ok(())
}

/// Enlarges a box by a `margin` (m).
pub(super) fn grown(bounds: &BoundingBox, margin: f64) -> AABB<TreePoint> {
    AABB::from_corners((bounds.min.x - margin, bounds.min.y - margin), (bounds.max.x + margin, bounds.max.y + margin))
}

/// The vertices that two pieces of a chain share.
fn shared_vertices(pieces: &[Piece], closed: bool, first: usize, second: usize) -> Vec<Point2> {
    let mut vertices = Vec::new();
    if second == first + 1 {
        vertices.push(pieces[first].end());
    }
    if closed && first == 0 && second + 1 == pieces.len() {
        vertices.push(pieces[second].end());
    }
    vertices
}

/// A common point of two pieces within a `tolerance` (m), other than their shared vertices.
///
/// Pieces that meet cross or touch, or an end of one is on the other. If they cover each other, an end of one is on the
/// other.
pub(super) fn meeting(a: &Piece, b: &Piece, vertices: &[Point2], tolerance: f64) -> Option<Point2> {
    let ends = [a.start(), a.end(), b.start(), b.end()];
    let crossings = match vertices.first() {
        Some(&vertex) => [second_crossing(a, b, vertex), None],
        None => crossings(a, b, tolerance),
    };
    let shared = |point: &Point2| a.distance(*point) <= tolerance && b.distance(*point) <= tolerance;
    let at_vertex = |point: &Point2| vertices.iter().any(|vertex| (point - vertex).norm() <= 2.0 * tolerance);
    ends.into_iter().chain(crossings.into_iter().flatten()).find(|point| shared(point) && !at_vertex(point))
}

/// The second intersection of the lines or circles of two pieces, given one intersection. It is the mirror image in the
/// common axis of symmetry.
///
/// A general solution has a double root only to the square root of rounding. This one is exact for pieces with a common
/// tangent, for which both intersections coincide.
fn second_crossing(a: &Piece, b: &Piece, crossing: Point2) -> Option<Point2> {
    let (on_axis, along_axis) = match (a, b) {
        (Piece::Segment(_), Piece::Segment(_)) => return None,
        (Piece::Segment(line), Piece::Arc(arc)) | (Piece::Arc(arc), Piece::Segment(line)) => {
            (arc.centre, perpendicular(line.tangent()))
        }
        (Piece::Arc(a), Piece::Arc(b)) => (a.centre, (b.centre - a.centre).try_normalize(0.0)?),
    };
    let from_axis = crossing - on_axis;
    Some(on_axis + 2.0 * along_axis * along_axis.dot(&from_axis) - from_axis)
}

/// The intersections of the lines or circles of two pieces, or the points at which they touch within a `tolerance` (m).
pub(super) fn crossings(a: &Piece, b: &Piece, tolerance: f64) -> [Option<Point2>; 2] {
    match (a, b) {
        (Piece::Segment(a), Piece::Segment(b)) => [line_line(a, b), None],
        (Piece::Segment(line), Piece::Arc(arc)) | (Piece::Arc(arc), Piece::Segment(line)) => {
            line_circle(line, arc, tolerance)
        }
        (Piece::Arc(a), Piece::Arc(b)) => circle_circle(a, b, tolerance),
    }
}

fn line_line(a: &Segment, b: &Segment) -> Option<Point2> {
    let along = a.tangent();
    let sine = along.perp(&b.tangent());
    let crossing = a.start + along * ((b.start - a.start).perp(&b.tangent()) / sine);
    (sine != 0.0).then_some(crossing)
}

fn line_circle(line: &Segment, circle: &Arc, tolerance: f64) -> [Option<Point2>; 2] {
    let along = line.tangent();
    let projection = line.start + along * (circle.centre - line.start).dot(&along);
    let distance = (projection - circle.centre).norm();
    if distance > circle.radius + tolerance {
        return [None; 2];
    }
    let half_chord = along * ((circle.radius - distance) * (circle.radius + distance)).max(0.0).sqrt();
    [Some(projection - half_chord), Some(projection + half_chord)]
}

fn circle_circle(a: &Arc, b: &Arc, tolerance: f64) -> [Option<Point2>; 2] {
    let between = b.centre - a.centre;
    let distance = between.norm();
    let apart = distance > a.radius + b.radius + tolerance;
    let nested = distance < (a.radius - b.radius).abs() - tolerance;
    if apart || nested || distance == 0.0 {
        return [None; 2];
    }
    let towards = between / distance;
    let to_chord = 0.5 * (distance + (a.radius - b.radius) * (a.radius + b.radius) / distance);
    let half_chord = perpendicular(towards) * ((a.radius - to_chord) * (a.radius + to_chord)).max(0.0).sqrt();
    let middle = a.centre + towards * to_chord;
    [Some(middle - half_chord), Some(middle + half_chord)]
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]

    use std::f64::consts::{FRAC_PI_2, PI};

    use vibrissa_runtime::math;

    use super::*;
    use crate::geometry::Contour;

    fn chain(points: &[(f64, f64)]) -> Vec<Piece> {
        points.windows(2).map(|w| Piece::segment(Point2::new(w[0].0, w[0].1), Point2::new(w[1].0, w[1].1))).collect()
    }

    fn met(result: Result<Contour, ContourError>) -> Option<(usize, usize)> {
        match result {
            Ok(_) => None,
            Err(ContourError::SelfIntersection { first, second, .. }) => Some((first, second)),
            Err(other) => panic!("{other}"),
        }
    }

    #[test]
    fn a_bow_tie_names_the_two_sides_that_cross() {
        let bow_tie = chain(&[(0.0, 0.0), (1.0, 1.0), (1.0, 0.0), (0.0, 1.0), (0.0, 0.0)]);
        let error = Contour::closed(bow_tie).unwrap_err();
        let ContourError::SelfIntersection { first: 0, second: 2, at } = error else { panic!("{error}") };
        assert!((at - Point2::new(0.5, 0.5)).norm() < 1e-15);
    }

    #[test]
    fn touching_is_meeting() {
        let corner_on_side = chain(&[(0.0, 0.0), (2.0, 0.0), (2.0, 1.0), (1.0, 0.0), (0.0, 1.0), (0.0, 0.0)]);
        assert!(met(Contour::closed(corner_on_side)).is_some());
        // The top of a circle, tangent to a line above it.
        let mut line_on_circle = chain(&[(-1.0, 1.0), (1.0, 1.0), (2.0, 0.0), (1.0, -1.0), (0.5, -1.0), (1.0, 0.0)]);
        line_on_circle.push(Piece::arc(Point2::origin(), 1.0, 0.0, PI));
        assert_eq!(met(Contour::open(line_on_circle)), Some((0, 5)));
    }

    #[test]
    fn going_back_over_a_piece_is_meeting() {
        assert_eq!(met(Contour::open(chain(&[(0.0, 0.0), (1.0, 0.0), (0.3, 0.0)]))), Some((0, 1)));
        assert_eq!(met(Contour::closed(chain(&[(0.0, 0.0), (1.0, 0.0), (0.0, 0.0)]))), Some((0, 1)));
    }

    #[test]
    fn smooth_joints_and_cusps_are_no_meetings() {
        let hook = vec![
            Piece::segment(Point2::new(-1.0, 0.0), Point2::origin()),
            Piece::arc(Point2::new(0.0, 0.3), 0.3, -FRAC_PI_2, 1.9 * PI),
        ];
        assert_eq!(met(Contour::open(hook)), None);
        let cusp = vec![
            Piece::segment(Point2::new(-1.0, 0.0), Point2::origin()),
            Piece::arc(Point2::new(0.0, 0.3), 0.3, -FRAC_PI_2, -1.5 * PI),
        ];
        assert_eq!(met(Contour::open(cusp)), None);
    }

    #[test]
    fn an_arc_that_comes_back_through_its_neighbour_is_meeting() {
        let tangle = vec![
            Piece::segment(Point2::new(-2.0, 0.5), Point2::origin()),
            Piece::arc(Point2::new(0.0, 1.0), 1.0, -FRAC_PI_2, 1.9 * PI),
        ];
        assert_eq!(met(Contour::open(tangle)), Some((0, 1)));
        let rings = vec![
            Piece::arc(Point2::new(-0.5, 0.0), 1.0, -PI, 1.9 * PI),
            Piece::segment(
                Point2::new(-0.5 + math::cos(0.9 * PI), math::sin(0.9 * PI)),
                Point2::new(-0.5 + 2.0 * math::cos(0.9 * PI), 2.0 * math::sin(0.9 * PI)),
            ),
        ];
        assert_eq!(met(Contour::open(rings)), None);
    }
}
