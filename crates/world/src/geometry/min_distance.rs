//! The minimum distance from the objects in a tree of bounding boxes.

use rstar::{AABB, ParentNode, RTree, RTreeNode, RTreeObject};

use super::{Point2, TreePoint, tree_point};

/// The rounding error (m) by which a box may seem farther away than its content.
const SLACK: f64 = 1e-12;

/// The minimum distance (m) of a point from the objects of a tree, or `within` if none is nearer. `distance` returns
/// the distance of an object.
///
/// The search first descends to the nearest box, then visits only boxes that are nearer than the current minimum. The
/// tree's own iterator keeps a list of visited nodes. It also returns the nearest object, and takes several times as
/// long.
pub fn min_distance<T: RTreeObject<Envelope = AABB<TreePoint>>>(
    tree: &RTree<T>,
    point: Point2,
    within: f64,
    distance: impl Fn(&T) -> f64,
) -> f64 {
    min_distance_down_to(f64::NEG_INFINITY, tree, point, within, distance)
}

/// The same for a caller that needs no distance below `enough` (m). The result is exact above it. Below it, the result is
/// any distance of an object that is at most `enough`.
pub fn min_distance_down_to<T: RTreeObject<Envelope = AABB<TreePoint>>>(
    enough: f64,
    tree: &RTree<T>,
    point: Point2,
    within: f64,
    distance: impl Fn(&T) -> f64,
) -> f64 {
    let mut search = Search { point: tree_point(point), least: within, enough, distance };
    search.descend(tree.root());
    search.least
}

/// The squared distance (m²) of a point from a box, bit by bit that of the tree's own function, which is not inlined and so
/// takes several times as long.
fn apart_2(bounds: &AABB<TreePoint>, point: TreePoint) -> f64 {
    let (lower, upper) = (bounds.lower(), bounds.upper());
    let beyond = |lower: f64, upper: f64, at: f64| {
        let not_below = if lower > at { lower } else { at };
        (if upper < not_below { upper } else { not_below }) - at
    };
    let (x, y) = (beyond(lower.0, upper.0, point.0), beyond(lower.1, upper.1, point.1));
    x * x + y * y
}

struct Search<D> {
    point: TreePoint,
    least: f64,
    enough: f64,
    distance: D,
}

impl<D> Search<D> {
    fn is_near(&self, apart: f64) -> bool {
        apart <= (self.least + SLACK) * (self.least + SLACK)
    }

    fn descend<T: RTreeObject<Envelope = AABB<TreePoint>>>(&mut self, node: &ParentNode<T>)
    where
        D: Fn(&T) -> f64,
    {
        let mut nearest: Option<(f64, &ParentNode<T>)> = None;
        for child in node.children() {
            match child {
                RTreeNode::Leaf(leaf) => {
                    if self.is_near(apart_2(&leaf.envelope(), self.point)) {
                        self.least = self.least.min((self.distance)(leaf));
                        if self.least <= self.enough {
                            return;
                        }
                    }
                }
                RTreeNode::Parent(inner) => {
                    let apart = apart_2(&inner.envelope(), self.point);
                    if self.is_near(apart) && nearest.is_none_or(|(nearest, _)| apart < nearest) {
                        nearest = Some((apart, inner));
                    }
                }
            }
        }
        let Some((_, nearest)) = nearest else { return };
        self.descend(nearest);
        for child in node.children() {
            if self.least <= self.enough {
                return;
            }
            if let RTreeNode::Parent(inner) = child
                && !std::ptr::eq(inner, nearest)
                && self.is_near(apart_2(&inner.envelope(), self.point))
            {
                self.descend(inner);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn a_box_is_as_far_as_for_the_tree_bit_by_bit(
            (a, b, point) in (
                (-1.0..1.0_f64, -1.0..1.0_f64), (-1.0..1.0_f64, -1.0..1.0_f64), (-2.0..2.0_f64, -2.0..2.0_f64),
            ),
        ) {
            let bounds = AABB::from_corners(a, b);
            for point in [point, a, b, (point.0, a.1), (f64::INFINITY, point.1)] {
                prop_assert_eq!(apart_2(&bounds, point).to_bits(), bounds.distance_2(&point).to_bits());
            }
        }
    }
}
