//! The least distance from what is in a tree of boxes.

use rstar::{AABB, ParentNode, RTree, RTreeNode, RTreeObject};

use super::Point2;

/// How much (m) rounding may put a box farther off than what is in it.
const SLACK: f64 = 1e-12;

/// The least distance (m) of a point from the objects of a tree, of which each has the `distance` that is told; `within` if none is
/// nearer than that.
///
/// It goes straight down to the box that is nearest, and then into those alone that are nearer than what it has found. The tree's own
/// iterator keeps a list of all that it passes: it can tell which object is nearest, and takes several times as long.
pub(crate) fn min_distance<T: RTreeObject<Envelope = AABB<[f64; 2]>>>(
    tree: &RTree<T>,
    point: Point2,
    within: f64,
    distance: impl Fn(&T) -> f64,
) -> f64 {
    let mut least = within;
    descend(tree.root(), &point.into(), &mut least, &distance);
    least
}

fn descend<T: RTreeObject<Envelope = AABB<[f64; 2]>>>(
    node: &ParentNode<T>,
    point: &[f64; 2],
    least: &mut f64,
    distance: &impl Fn(&T) -> f64,
) {
    let is_near = |apart: f64, least: f64| apart <= (least + SLACK) * (least + SLACK);
    let mut nearest: Option<(f64, &ParentNode<T>)> = None;
    for child in node.children() {
        match child {
            RTreeNode::Leaf(leaf) => {
                if is_near(leaf.envelope().distance_2(point), *least) {
                    *least = least.min(distance(leaf));
                }
            }
            RTreeNode::Parent(inner) => {
                let apart = inner.envelope().distance_2(point);
                if is_near(apart, *least) && nearest.is_none_or(|(nearest, _)| apart < nearest) {
                    nearest = Some((apart, inner));
                }
            }
        }
    }
    let Some((_, nearest)) = nearest else { return };
    descend(nearest, point, least, distance);
    for child in node.children() {
        if let RTreeNode::Parent(inner) = child
            && !std::ptr::eq(inner, nearest)
            && is_near(inner.envelope().distance_2(point), *least)
        {
            descend(inner, point, least, distance);
        }
    }
}
