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
                    if self.is_near(leaf.envelope().distance_2(&self.point)) {
                        self.least = self.least.min((self.distance)(leaf));
                        if self.least <= self.enough {
                            return;
                        }
                    }
                }
                RTreeNode::Parent(inner) => {
                    let apart = inner.envelope().distance_2(&self.point);
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
                && self.is_near(inner.envelope().distance_2(&self.point))
            {
                self.descend(inner);
            }
        }
    }
}
