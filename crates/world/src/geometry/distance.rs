//! Nearest points and distances, by a tree of the pieces' bounding boxes.

use std::cell::Cell;

use rstar::{AABB, PointDistance, RTree, RTreeObject};
use vibrissa_runtime::math;

use super::{
    Contour, Piece, Point2, TreePoint, Vector2, corner, min_distance, min_distance_down_to, plane_point, tree_point,
};

/// The rounding error (m) of a bounding box.
const BOX_ROUNDING: f64 = 1e-9;

/// The point of a contour nearest to a given one.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Nearest {
    /// The nearest point (m).
    pub point: Point2,
    /// Its arc length (m), less than the length of a closed contour.
    pub arc_length: f64,
    /// Its distance from the given point (m), never negative.
    pub distance: f64,
    /// The tangent there, a unit vector in the direction of travel. At a corner, it belongs to one of the two pieces.
    pub tangent: Vector2,
}

impl Contour {
    /// The nearest point of the contour. Of several equally near points, always the same is returned.
    ///
    /// ```
    /// use vibrissa_world::geometry::{Point2, circle};
    /// let disk = circle(Point2::new(0.4, 0.4), 0.3)?;
    /// let nearest = disk.nearest(Point2::new(0.4, 0.9));
    /// assert!((nearest.point - Point2::new(0.4, 0.7)).norm() < 1e-15);
    /// assert!((nearest.distance - 0.2).abs() < 1e-15);
    /// # Ok::<(), vibrissa_world::geometry::ShapeError>(())
    /// ```
    #[must_use]
    pub fn nearest(&self, point: Point2) -> Nearest {
        let (index, along) = self.project(point);
        let piece = &self.pieces[index];
        let arc_length = self.starts[index] + along;
        Nearest {
            point: piece.point_at(along),
            arc_length: if self.closed && arc_length >= self.length { 0.0 } else { arc_length },
            distance: piece.distance(point),
            tangent: piece.tangent_at(along),
        }
    }

    /// Distance (m) of a point from the contour, never negative. Infinite if the point is not finite. It equals the
    /// distance of [`nearest`](Self::nearest) and is faster.
    #[must_use]
    pub fn distance(&self, point: Point2) -> f64 {
        self.distance_within(point, f64::INFINITY)
    }

    /// The nearest point (m) and its arc length (m), less than the length of a closed contour. They equal those of
    /// [`nearest`](Self::nearest), unless two pieces are equally near, and are found faster.
    #[must_use]
    pub fn nearest_point(&self, point: Point2) -> (Point2, f64) {
        let nearest = Cell::new((f64::INFINITY, 0));
        min_distance(&self.tree, point, f64::INFINITY, |leaf| {
            let distance = leaf.distance(point);
            if distance < nearest.get().0 {
                nearest.set((distance, leaf.index));
            }
            distance
        });
        let index = nearest.get().1;
        let along = self.pieces[index].nearest(point);
        let arc_length = self.starts[index] + along;
        let arc_length = if self.closed && arc_length >= self.length { 0.0 } else { arc_length };
        (self.pieces[index].point_at(along), arc_length)
    }

    /// True if a point is at most `distance` (m) away from the contour. It takes the less time, the farther away the point is.
    #[must_use]
    pub fn is_within(&self, distance: f64, point: Point2) -> bool {
        let within = distance.next_up();
        min_distance_down_to(distance, &self.tree, point, within, |leaf| leaf.distance(point)) <= distance
    }

    /// The minimum of the distance and `within` (m).
    pub(super) fn distance_within(&self, point: Point2, within: f64) -> f64 {
        min_distance(&self.tree, point, within, |leaf| leaf.distance(point))
    }

    /// Signed distance (m) from the contour: positive on the right of the direction of travel, which is the outside of
    /// a closed contour, and negative on the left.
    ///
    /// Beyond an end of an open contour, its tangent line separates the sides.
    ///
    /// ```
    /// use vibrissa_world::geometry::{Point2, polygon};
    /// let triangle = polygon(&[Point2::new(0.0, 0.0), Point2::new(2.0, 0.0), Point2::new(0.0, 2.0)])?;
    /// assert!((triangle.signed_distance(Point2::new(0.5, 0.1)) + 0.1).abs() < 1e-15);
    /// assert!((triangle.signed_distance(Point2::new(5.0, -4.0)) - 5.0).abs() < 1e-15);
    /// # Ok::<(), vibrissa_world::geometry::ShapeError>(())
    /// ```
    #[must_use]
    pub fn signed_distance(&self, point: Point2) -> f64 {
        let (index, along) = self.project(point);
        let distance = self.pieces[index].distance(point);
        if distance > 0.0 { distance * self.side(index, along, point) } else { distance }
    }

    /// True if a point is strictly inside of a closed contour. Always false for an open one.
    #[must_use]
    pub fn contains(&self, point: Point2) -> bool {
        // Most points of a scene are far from most contours.
        self.closed && self.bounding_box().distance(point) <= BOX_ROUNDING && self.signed_distance(point) < 0.0
    }

    /// The piece nearest to a point, and the arc length of the nearest point on it.
    fn project(&self, point: Point2) -> (usize, f64) {
        // The tree's `nearest_neighbor` prunes by a bound that assumes exact boxes. It misses a nearest piece at a
        // corner of its box now and then. The iterator does not.
        let nearest = self.tree.nearest_neighbor_iter(tree_point(point)).next();
        // Only points that are not finite have no nearest piece. Their distances are not finite either.
        let index = nearest.map_or(0, |leaf| leaf.index);
        (index, self.pieces[index].nearest(point))
    }

    /// The side of the contour, +1 right or −1 left, of a point whose nearest point is at `along` on the piece `index`.
    fn side(&self, index: usize, along: f64, point: Point2) -> f64 {
        let piece = &self.pieces[index];
        let from_nearest = point - piece.point_at(along);
        let to_end = piece.length() - along;
        let (to_vertex, vertex) = if along < to_end {
            (along, self.before(index).map(|before| (before, index)))
        } else {
            (to_end, self.after(index).map(|after| (index, after)))
        };
        match vertex {
            Some((_, after)) if corner::is_ambiguous_at_cusp(self.turns[after], to_vertex, from_nearest) => {
                self.turns[after].signum()
            }
            Some((before, after)) if to_vertex <= 0.0 => {
                let incoming = self.pieces[before].tangent_at(self.pieces[before].length());
                let outgoing = self.pieces[after].tangent_at(0.0);
                corner::side(self.turns[after], incoming, outgoing, from_nearest)
            }
            _ => corner::right_of(piece.tangent_at(along), from_nearest),
        }
    }

    fn before(&self, index: usize) -> Option<usize> {
        if index > 0 { Some(index - 1) } else { self.closed.then(|| self.pieces.len() - 1) }
    }

    fn after(&self, index: usize) -> Option<usize> {
        if index + 1 < self.pieces.len() { Some(index + 1) } else { self.closed.then_some(0) }
    }
}

/// A piece in the tree.
#[derive(Clone, Debug)]
pub(super) struct Leaf {
    pub(super) index: usize,
    pub(super) piece: Piece,
    /// The spokes of an arc, which every distance query needs.
    spokes: [Vector2; 2],
    envelope: AABB<TreePoint>,
}

impl Leaf {
    pub(super) fn tree(pieces: &[Piece]) -> RTree<Self> {
        let leaf = |(index, piece): (usize, &Piece)| {
            let bounds = piece.bounding_box();
            let envelope = AABB::from_corners(tree_point(bounds.min), tree_point(bounds.max));
            let spokes = if let Piece::Arc(arc) = piece { arc.spokes() } else { [Vector2::zeros(); 2] };
            Self { index, piece: *piece, spokes, envelope }
        };
        RTree::bulk_load(pieces.iter().enumerate().map(leaf).collect())
    }
}

impl Leaf {
    fn distance(&self, point: Point2) -> f64 {
        match &self.piece {
            Piece::Segment(segment) => segment.distance(point),
            Piece::Arc(arc) => arc.distance_by(self.spokes, point),
        }
    }
}

impl RTreeObject for Leaf {
    type Envelope = AABB<TreePoint>;

    fn envelope(&self) -> Self::Envelope {
        self.envelope
    }
}

impl PointDistance for Leaf {
    fn distance_2(&self, point: &TreePoint) -> f64 {
        math::square(self.distance(plane_point(*point)))
    }
}
