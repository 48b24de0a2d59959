//! Ground around the start that the platform cannot leave.

use std::cmp::Ordering;
use std::collections::{BinaryHeap, HashMap, HashSet};

use vibrissa_runtime::rig::Rig;
use vibrissa_world::geometry::{BoundingBox, Point2, Pose, Vector2};

use super::outlines::{Outlines, inner_radius, middle_of};

/// Cells in the radius of the disc that is moved instead of the platform.
const CELLS: f64 = 8.0;
/// Most nodes of an enclosure: some 25 m² for the reference rig. A larger one counts as open.
const MOST_NODES: usize = 1 << 20;
/// Largest distance (m) from the outlines that is measured.
const MOST_CLEARANCE: f64 = 0.5;
/// Neighbours of a node.
const STEPS: [Node; 8] = [(1, 0), (0, 1), (-1, 0), (0, -1), (1, 1), (-1, 1), (-1, -1), (1, -1)];

/// A node of the grid, by its column and row.
type Node = (i64, i64);

/// The positions to which the middle of the platform's footprint can move from the start, if objects enclose them.
///
/// The footprint is replaced by the disc in it. So the positions are those that the platform can reach, and perhaps more.
#[derive(Debug)]
pub(super) struct Enclosure {
    /// Distance of the nodes (m).
    cell: f64,
    /// The nodes of these positions, and those by which a sampled pose may lie beside the true one.
    nodes: HashSet<Node>,
    /// The nodes within an arm of these.
    near: HashSet<Node>,
}

impl Enclosure {
    /// The enclosure of a platform with this pose at the start, for poses that are known up to `margin` (m) and points up to
    /// `arm` (m) from the middle. `None` if the platform can leave all objects behind, or if it overlaps one.
    pub(super) fn new(start: Pose, rig: &Rig, outlines: &Outlines<'_>, margin: f64, arm: f64) -> Option<Self> {
        let corners = rig.platform.outline_body();
        let radius = Some(inner_radius(&corners)).filter(|radius| *radius > 0.0 && radius.is_finite())?;
        let cell = radius / CELLS;
        // A path of the middle is within half a diagonal of nodes that are neighbours.
        let least = radius - cell * 0.5_f64.sqrt();
        let far = outlines.bounding_box();
        let beyond = Vector2::new(radius, radius);
        let far = BoundingBox { min: far.min - beyond, max: far.max + beyond };
        let first = node_at(start.point_to_world(middle_of(&corners)), cell)?;
        #[expect(clippy::cast_possible_truncation, reason = "a small count")]
        let around = (2.0 * margin / cell).ceil() as i64 + 1;
        let mut nodes = HashMap::new();
        let clearance = |node| outlines.clearance(place(node, cell), MOST_CLEARANCE);
        let mut open = BinaryHeap::new();
        nodes.insert(first, Some(clearance(first)).filter(|own| *own >= least)?);
        open.push(Reached { outside: outside(&far, place(first, cell)), node: first });
        while let Some(Reached { outside: left, node }) = open.pop() {
            if left <= 0.0 || nodes.len() > MOST_NODES {
                return None;
            }
            let known = nodes.get(&node).copied().unwrap_or_default();
            for (columns, rows) in STEPS {
                let next = (node.0 + columns, node.1 + rows);
                if nodes.contains_key(&next) {
                    continue;
                }
                // The clearance changes by no more than the step, so that few nodes are measured.
                let at_least = known - (place(next, cell) - place(node, cell)).norm();
                let own = if at_least >= least { at_least } else { clearance(next) };
                if own >= least {
                    nodes.insert(next, own);
                    open.push(Reached { outside: outside(&far, place(next, cell)), node: next });
                }
            }
        }
        let nodes = grown(&nodes.into_keys().collect(), around);
        #[expect(clippy::cast_possible_truncation, reason = "a small count")]
        let near = grown(&nodes, (arm / cell).ceil() as i64 + 1);
        Some(Self { cell, nodes, near })
    }

    /// True if the middle of the footprint may come within an arm of a point.
    pub(super) fn is_near(&self, point: Point2) -> bool {
        node_at(point, self.cell).is_some_and(|node| self.near.contains(&node))
    }

    /// True if the middle of the footprint may come to a point.
    pub(super) fn admits(&self, middle: Point2) -> bool {
        node_at(middle, self.cell).is_some_and(|node| self.nodes.contains(&node))
    }
}

/// The nodes with the squares around them that have so many nodes on each side.
fn grown(nodes: &HashSet<Node>, around: i64) -> HashSet<Node> {
    let mut grown = nodes.clone();
    // A square around an inner node adds nothing that those around the outer ones do not.
    let has_all = |(column, row): Node| STEPS.iter().all(|step| nodes.contains(&(column + step.0, row + step.1)));
    for &(column, row) in nodes.iter().filter(|node| !has_all(**node)) {
        let square = (-around..=around).flat_map(|rows| (-around..=around).map(move |columns| (columns, rows)));
        grown.extend(square.map(|step| (column + step.0, row + step.1)));
    }
    grown
}

/// The distance (m) from a point to the nearest side of a box. Not positive outside.
fn outside(far: &BoundingBox, point: Point2) -> f64 {
    let (low, high) = (point - far.min, far.max - point);
    low.inf(&high).min()
}

fn place((column, row): Node, cell: f64) -> Point2 {
    Point2::new(column as f64 * cell, row as f64 * cell)
}

/// The node that is nearest to a point. `None` for a point that is far away or not finite.
#[expect(clippy::cast_possible_truncation, reason = "the coordinates are in range")]
fn node_at(point: Point2, cell: f64) -> Option<Node> {
    let (column, row) = ((point.x / cell).round(), (point.y / cell).round());
    (column.abs() < 1e12 && row.abs() < 1e12).then_some((column as i64, row as i64))
}

/// A node that was reached. The order is reversed for a priority queue of those nearest to the outside.
#[derive(PartialEq)]
struct Reached {
    outside: f64,
    node: Node,
}

impl Eq for Reached {}

impl Ord for Reached {
    fn cmp(&self, other: &Self) -> Ordering {
        other.outside.total_cmp(&self.outside)
    }
}

impl PartialOrd for Reached {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}
