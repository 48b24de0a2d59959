//! The minimum distance from the objects in a tree of bounding boxes.

use rstar::{AABB, ParentNode, RTree, RTreeNode, RTreeObject};

use super::Point2;

/// The rounding error (m) by which a box may seem farther away than its content.
const SLACK: f64 = 1e-12;

/// The minimum distance (m) of a point from the objects of a tree, or `within` if none is nearer. `distance` returns
/// the distance of an object.
///
/// The search first descends to the nearest box, then visits only boxes that are nearer than the current minimum. The
/// tree's own iterator keeps a list of visited nodes. It also returns the nearest object, and takes several times as
/// long.
pub fn min_distance<T: RTreeObject<Envelope = AABB<[f64; 2]>>>(
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
