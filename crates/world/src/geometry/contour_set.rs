//! Sets of contours.

use rstar::RTree;
use rstar::primitives::{GeomWithData, Rectangle};

use super::{BoundingBox, Contour, Nearest, Point2, TreePoint, min_distance, tree_point};

/// The largest number of contours that are tested one by one. More of them have a tree.
const MOST_WITHOUT_TREE: usize = 16;

/// The rounding error (m) of the distance of a box.
const SLACK: f64 = 1e-12;

/// A non-empty set of contours with common distance queries. Arc lengths continue from one contour to the next.
///
/// ```
/// use vibrissa_world::geometry::{ContourSet, Point2, circle};
/// let disk = |x| circle(Point2::new(x, 0.0), 0.1);
/// let pair = ContourSet::new(vec![disk(0.0)?, disk(1.0)?]).unwrap();
/// assert!((pair.length() - 0.4 * std::f64::consts::PI).abs() < 1e-15);
/// assert!((pair.nearest(Point2::new(0.7, 0.0)).distance - 0.2).abs() < 1e-15);
/// # Ok::<(), vibrissa_world::geometry::ShapeError>(())
/// ```
#[derive(Clone, Debug)]
pub struct ContourSet {
    first: Contour,
    rest: Vec<Contour>,
    /// The bounding boxes of all contours with their indices. `None` for a few contours.
    tree: Option<RTree<GeomWithData<Rectangle<TreePoint>, usize>>>,
}

impl ContourSet {
    /// The set of `contours`. `None` if there are none.
    #[must_use]
    pub fn new(contours: impl IntoIterator<Item = Contour>) -> Option<Self> {
        let mut contours = contours.into_iter();
        let mut set = Self { first: contours.next()?, rest: contours.collect(), tree: None };
        if set.rest.len() >= MOST_WITHOUT_TREE {
            let boxes = set.contours().enumerate().map(|(index, contour)| {
                let BoundingBox { min, max } = contour.bounding_box();
                GeomWithData::new(Rectangle::from_corners(tree_point(min), tree_point(max)), index)
            });
            set.tree = Some(RTree::bulk_load(boxes.collect()));
        }
        Some(set)
    }

    /// The contours, in the given order.
    pub fn contours(&self) -> impl Iterator<Item = &Contour> {
        std::iter::once(&self.first).chain(&self.rest)
    }

    /// Total length (m).
    #[must_use]
    pub fn length(&self) -> f64 {
        self.rest.iter().fold(self.first.length(), |length, contour| length + contour.length())
    }

    /// The nearest point of all contours. Of several equally near points, always the same is returned.
    #[must_use]
    pub fn nearest(&self, point: Point2) -> Nearest {
        self.nearest_by_tree(point).unwrap_or_else(|| self.nearest_of_list(point))
    }

    /// The same as [`nearest_of_list`](Self::nearest_of_list). `None` without a tree, or if the point is not finite.
    fn nearest_by_tree(&self, point: Point2) -> Option<Nearest> {
        let tree = self.tree.as_ref()?;
        let distance = self.distance(point);
        let reach = (distance + SLACK) * (distance + SLACK);
        let in_reach = tree.locate_within_distance(tree_point(point), reach).map(|leaf| leaf.data);
        // Of several equally near contours, the first one counts.
        let index =
            in_reach.filter(|&index| self.contour(index).is_some_and(|at| at.distance(point) <= distance)).min()?;
        let start = self.contours().take(index).fold(0.0, |start, contour| start + contour.length());
        let nearest = self.contour(index)?.nearest(point);
        Some(Nearest { arc_length: start + nearest.arc_length, ..nearest })
    }

    fn nearest_of_list(&self, point: Point2) -> Nearest {
        let mut nearest = self.first.nearest(point);
        let mut start = self.first.length();
        for contour in &self.rest {
            // Each contour has a tree of its pieces. The bounding boxes exclude distant contours.
            if contour.bounding_box().distance(point) < nearest.distance {
                let found = contour.nearest(point);
                if found.distance < nearest.distance {
                    nearest = Nearest { arc_length: start + found.arc_length, ..found };
                }
            }
            start += contour.length();
        }
        nearest
    }

    /// Distance (m) of a point from the nearest contour, never negative. Infinite if the point is not finite. It equals
    /// the distance of [`nearest`](Self::nearest) and is faster.
    #[must_use]
    pub fn distance(&self, point: Point2) -> f64 {
        let Some(tree) = &self.tree else {
            return self.contours().fold(f64::INFINITY, |within, contour| contour.distance_within(point, within));
        };
        let of = |index| self.contour(index).map_or(f64::INFINITY, |contour| contour.distance(point));
        min_distance(tree, point, f64::INFINITY, |leaf| of(leaf.data))
    }

    /// The contour with this index.
    fn contour(&self, index: usize) -> Option<&Contour> {
        if index == 0 { Some(&self.first) } else { self.rest.get(index - 1) }
    }

    /// True if a point is at most `distance` (m) away from a contour.
    #[must_use]
    pub fn is_within(&self, distance: f64, point: Point2) -> bool {
        self.contours().any(|contour| contour.is_within(distance, point))
    }

    /// The bounding box of all contours.
    #[must_use]
    pub fn bounding_box(&self) -> BoundingBox {
        self.rest.iter().fold(self.first.bounding_box(), |bounds, contour| bounds.union(&contour.bounding_box()))
    }
}

impl From<Contour> for ContourSet {
    fn from(contour: Contour) -> Self {
        Self { first: contour, rest: Vec::new(), tree: None }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]
    use super::*;
    use crate::geometry::circle;

    #[test]
    fn many_contours_with_a_tree_are_as_near_as_those_of_a_list_bit_by_bit() {
        // Points between disks are equally far from two or four of them.
        let disks = (0..10).flat_map(|row| (0..10).map(move |column| (f64::from(column), f64::from(row))));
        let set = ContourSet::new(disks.map(|(x, y)| circle(Point2::new(x, y), 0.25).unwrap())).unwrap();
        assert!(set.tree.is_some());
        for (x, y) in (-4..44).flat_map(|x| (-4..44).map(move |y| (0.25 * f64::from(x), 0.25 * f64::from(y)))) {
            for point in [Point2::new(x, y), Point2::new(x + 0.013, y - 0.07)] {
                let (found, expected) = (set.nearest(point), set.nearest_of_list(point));
                assert_eq!(found, expected, "{point}");
                let of_list = set.contours().fold(f64::INFINITY, |within, disk| disk.distance_within(point, within));
                assert_eq!(set.distance(point).to_bits(), of_list.to_bits(), "{point}");
            }
        }
        assert!(set.distance(Point2::new(f64::NAN, 0.0)).is_infinite());
    }
}
