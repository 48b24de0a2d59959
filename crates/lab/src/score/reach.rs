//! Parts of an outline that the rig cannot reach.

use std::cell::OnceCell;
use std::cmp::Ordering;
use std::collections::{BinaryHeap, HashMap};
use std::f64::consts::TAU;
use std::ops::Range;

use super::Estimate;
use super::coverage::traced_outlines;
use super::enclosure::Enclosure;
use super::isolated::{is_convex, lies_beyond_wall};
use super::outlines::{Outlines, inner_radius, middle_of};
use vibrissa_runtime::math;
use vibrissa_runtime::rig::Rig;
use vibrissa_world::geometry::{Contour, Point2, Pose, Vector2, perpendicular, rotate};
use vibrissa_world::scene::Truth;

/// Cell size (m) of the grid on which the base of a whisker and its shaft are searched. Narrower gaps count as closed.
const CELL_SIZE: f64 = 2.5e-3;
/// The number of sampled headings of the platform.
const HEADINGS: u32 = 240;
/// Lengths of a straight whisker, as shares of the longest one, that are tested before any search.
const STRAIGHT_REACHES: [f64; 3] = [0.8, 0.4, 0.15];
pub(super) const STRAIGHT_HEADINGS: u32 = 24;
/// Distance (m) between the sampled points of an outline.
const SPACING: f64 = 4e-3;
/// The largest ratio of a path along sides and diagonals of cells to the straight distance.
const DETOUR: f64 = 1.0824;
/// The width (m) of a gap up to which it is closed for a whisker of an enclosed platform.
const SLIT: f64 = 2.0 * CELL_SIZE;
/// The distance (m) from a point without a near base within which others are not searched again.
const SHARED: f64 = 0.1;
/// The distance (m) of the sampled points from the outline, on the outside.
const OUTSIDE_OFFSET: f64 = 1e-5;

/// The length (m) of the untraced reference that no tip of the rig can touch from any pose. `start` is the pose of the platform at
/// the start, if it is known.
///
/// A tip can touch a point only under two conditions. The platform has a pose in which its footprint is clear of all
/// solids. The shortest path through free space from the base of a whisker to the point is no longer than the whisker,
/// because a bent shaft is never shorter than this path. If objects enclose the start, the platform can also move to the pose:
/// the disc in its footprint passes every gap on its path. Other conditions are ignored: whether the footprint passes them, how far
/// a shaft can bend, and where the other whiskers are. The result is therefore a lower bound.
///
/// Poses are sampled on a grid. Footprints are reduced by the distance between neighbouring poses, some 4 mm for the
/// reference rig. In a tapered gap, this admits some 15 mm more. Points are sampled every 4 mm.
#[must_use]
pub fn out_of_reach(estimate: &Estimate, truth: &Truth, rig: &Rig, start: Option<Pose>) -> f64 {
    out_of_reach_of(&traced_outlines(estimate, &truth.reference), truth, rig, start)
}

/// The same, by the traced intervals of each contour of the reference.
pub(super) fn out_of_reach_of(traced: &[Vec<Range<f64>>], truth: &Truth, rig: &Rig, start: Option<Pose>) -> f64 {
    let mut search = Search::new(rig, truth, start);
    let of_contour = |(contour, traced): (&Contour, &Vec<Range<f64>>)| -> f64 {
        if search.can_touch_all_around(contour) {
            return 0.0;
        }
        untraced(traced, contour.length()).map(|stretch| search.out_of_reach(contour, &stretch)).sum()
    };
    // An empty `sum` is negative zero.
    truth.reference.contours().zip(traced).map(of_contour).fold(0.0, |sum, length| sum + length)
}

/// The complement of some intervals in `0..length`.
fn untraced(traced: &[Range<f64>], length: f64) -> impl Iterator<Item = Range<f64>> {
    let starts = std::iter::once(0.0).chain(traced.iter().map(|stretch| stretch.end));
    let ends = traced.iter().map(|stretch| stretch.start).chain([length]);
    starts.zip(ends).map(|(start, end)| start..end).filter(|stretch| stretch.end > stretch.start)
}

/// A node of the grid, by its column and row.
type Node = (i64, i64);

/// A search through the free space of one scene. Results for nodes are cached.
struct Search<'s> {
    rig: &'s Rig,
    /// The pose of the platform at the start, if it is known.
    start: Option<Pose>,
    outlines: Outlines<'s>,
    /// For every whisker, the corners of the footprint relative to its base (m, body frame), reduced by the distance
    /// between neighbouring poses.
    mounts: Vec<[Vector2; 4]>,
    /// The largest of these reductions (m).
    margin: f64,
    /// The longest whisker (m).
    length: f64,
    /// The ground that the platform cannot leave. It is found when it is first asked for.
    enclosure: OnceCell<Option<Enclosure>>,
    /// The last point that is farther from all bases than a whisker's length and [`SHARED`].
    far: Option<Point2>,
    is_free: HashMap<Node, bool>,
    has_base: HashMap<Node, bool>,
    /// True for a line between two neighbouring nodes, the smaller one first, that crosses no outline.
    is_open: HashMap<(Node, Node), bool>,
}

impl<'s> Search<'s> {
    fn new(rig: &'s Rig, truth: &'s Truth, start: Option<Pose>) -> Self {
        let corners_body = rig.platform.outline_body();
        let mut widest: f64 = 0.0;
        let mounts = rig.whiskers.iter().map(|whisker| {
            let from_base = corners_body.map(|corner| corner - whisker.base_body);
            let arm = from_base.iter().map(Vector2::norm).fold(0.0, f64::max);
            // Half of a cell's diagonal, and half of the rotation between two headings.
            let margin = CELL_SIZE * 0.5_f64.sqrt() + arm * std::f64::consts::PI / f64::from(HEADINGS);
            widest = widest.max(margin);
            shrunk(from_base, margin)
        });
        let mounts = mounts.collect();
        Self {
            rig,
            start,
            margin: widest,
            enclosure: OnceCell::new(),
            far: None,
            outlines: Outlines::new(truth),
            mounts,
            length: rig.whiskers.iter().map(|whisker| whisker.shaft.length).fold(0.0, f64::max),
            is_free: HashMap::new(),
            has_base: HashMap::new(),
            is_open: HashMap::new(),
        }
    }

    /// True if a straight whisker touches every point of a contour from a pose in front of it: the outline of a convex object that
    /// is far from all others. Beyond its tangent the platform fits.
    fn can_touch_all_around(&self, contour: &Contour) -> bool {
        let distance = STRAIGHT_REACHES[0] * self.length;
        let arm = self.mounts.as_flattened().iter().map(Vector2::norm).fold(0.0, f64::max);
        self.outlines.is_alone(contour, distance + arm + 2.0 * OUTSIDE_OFFSET)
            && is_convex(contour)
            && lies_beyond_wall(&self.mounts, distance)
            && self.enclosure().is_none()
    }

    /// The length (m) of an interval of a contour that no tip can touch.
    fn out_of_reach(&mut self, contour: &Contour, stretch: &Range<f64>) -> f64 {
        let width = stretch.end - stretch.start;
        let pieces = (width / SPACING).ceil().max(1.0);
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a number of pieces")]
        let unreached = (0..pieces as usize).filter(|&index| {
            let s = stretch.start + (index as f64 + 0.5) / pieces * width;
            // The outside is on the right. An open contour may be touched from either side.
            let outwards = -OUTSIDE_OFFSET * perpendicular(contour.tangent_at(s));
            let at = contour.point_at(s);
            !self.can_touch(at, outwards) && (contour.is_closed() || !self.can_touch(at, -outwards))
        });
        unreached.count() as f64 * width / pieces
    }

    /// True if a tip may touch a point of an outline from the side of `outwards`.
    fn can_touch(&mut self, at: Point2, outwards: Vector2) -> bool {
        let from = at + outwards;
        // Nearly all reachable points have a pose directly in front of them. The search would take a thousand times as
        // long.
        self.outlines.is_outside(from) && (self.is_in_front(from, outwards.normalize()) || self.reaches(from))
    }

    /// True if the platform has a clear pose with a straight whisker along the normal of the outline at a point.
    fn is_in_front(&self, point: Point2, normal: Vector2) -> bool {
        STRAIGHT_REACHES.iter().any(|reach| {
            let base = point + reach * self.length * normal;
            self.outlines.is_open(point, base)
                && (0..STRAIGHT_HEADINGS).any(|index| {
                    let heading = TAU * f64::from(index) / f64::from(STRAIGHT_HEADINGS);
                    self.has_pose(base, heading + math::atan2(normal.y, normal.x))
                })
        })
    }

    /// True if the shortest path through free space from a point to a base of a whisker is no longer than the longest
    /// whisker.
    fn reaches(&mut self, point: Point2) -> bool {
        let most = DETOUR * self.length + 2.0 * CELL_SIZE;
        if self.enclosure().is_none() {
            return self.nearest_base(point, most).is_some();
        }
        // The whole outside of a room is out of reach, so one search serves the points around it as well.
        if self.far.is_some_and(|far| (point - far).norm() <= SHARED && self.outlines.is_open(far, point)) {
            return false;
        }
        let nearest = self.nearest_base(point, most + DETOUR * SHARED + 2.0 * CELL_SIZE);
        if nearest.is_none() {
            self.far = Some(point);
        }
        nearest.is_some_and(|length| length <= most)
    }

    /// The length (m) of the shortest path through free space from a point to a base of a whisker, up to `most` (m).
    fn nearest_base(&mut self, point: Point2, most: f64) -> Option<f64> {
        let mut open = BinaryHeap::new();
        let mut nearest: HashMap<Node, f64> = HashMap::new();
        let (column, row) = node_at(point);
        // In a corner, the nodes beside both walls are farther away.
        let within = if self.enclosure().is_some() { SLIT * 2.0_f64.sqrt() } else { 2.0 * CELL_SIZE };
        for node in (-1..=2).flat_map(|x| (-1..=2).map(move |y| (column + x, row + y))) {
            let length = (place(node) - point).norm();
            if length <= within && self.is_free(node) && self.outlines.is_open(point, place(node)) {
                nearest.insert(node, length);
                open.push(SearchPath { length, node });
            }
        }
        while let Some(SearchPath { length, node }) = open.pop() {
            if length > most {
                return None;
            }
            if nearest.get(&node).is_some_and(|&shorter| shorter < length) {
                continue;
            }
            if self.has_base(node) {
                return Some(length);
            }
            for step in [(1, 0), (0, 1), (-1, 0), (0, -1), (1, 1), (-1, 1), (-1, -1), (1, -1)] {
                let next = (node.0 + step.0, node.1 + step.1);
                let length = length + (place(next) - place(node)).norm();
                let is_shorter = nearest.get(&next).is_none_or(|&known| length < known);
                if is_shorter && self.is_free(next) && self.are_joined(node, next) {
                    nearest.insert(next, length);
                    open.push(SearchPath { length, node: next });
                }
            }
        }
        None
    }

    fn is_free(&mut self, node: Node) -> bool {
        if let Some(&known) = self.is_free.get(&node) {
            return known;
        }
        // The slit by which an outline encloses the start is closed wherever the nodes are.
        let is_free = match self.enclosure() {
            None => self.outlines.is_outside(place(node)),
            Some(_) => self.outlines.clearance(place(node), 0.5 * SLIT) >= 0.5 * SLIT,
        };
        self.is_free.insert(node, is_free);
        is_free
    }

    /// True if the line between two neighbouring nodes crosses no outline.
    fn are_joined(&mut self, one: Node, other: Node) -> bool {
        let (first, last) = (one.min(other), one.max(other));
        let outlines = &self.outlines;
        *self.is_open.entry((first, last)).or_insert_with(|| outlines.is_open(place(first), place(last)))
    }

    /// True if the platform has a clear pose with the base of a whisker within half a cell's diagonal of the node.
    fn has_base(&mut self, node: Node) -> bool {
        if let Some(&known) = self.has_base.get(&node) {
            return known;
        }
        let base = place(node);
        let is_near = self.enclosure().is_none_or(|enclosure| enclosure.is_near(base));
        let found = is_near && self.mounts.iter().any(|corners| self.has_heading(base, corners));
        self.has_base.insert(node, found);
        found
    }

    /// True if the platform has a clear pose with this base of a whisker at any sampled heading.
    fn has_heading(&self, base: Point2, corners: &[Vector2; 4]) -> bool {
        const STEP: f64 = TAU / HEADINGS as f64;
        let middle = corners.iter().fold(Vector2::zeros(), |sum, corner| sum + corner / 4.0);
        // A footprint that was reduced to a point has no sides.
        let inner_radius = Some(inner_radius(&corners.map(Point2::from))).filter(|radius| radius.is_finite());
        let inner_radius = inner_radius.unwrap_or_default();
        let mut index = 0;
        while index < HEADINGS {
            let heading = f64::from(index) * STEP;
            if !self.is_connected(base + rotate(middle, heading)) {
                index += 1;
                continue;
            }
            // The middle of the footprint moves by no more than its arc. So it stays that deep for some headings.
            let depth = self.outlines.depth(base + rotate(middle, heading), inner_radius);
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a number of headings")]
            let blocked = (depth / (middle.norm() * STEP)).floor().min(f64::from(HEADINGS)) as u32;
            if depth > 0.0 {
                index += 1 + blocked;
                continue;
            }
            if self.is_clear(base, corners, heading) {
                return true;
            }
            index += 1;
        }
        false
    }

    /// True if the platform with this `heading` (rad) and a base of a whisker at this point is clear of all solids.
    fn has_pose(&self, base: Point2, heading: f64) -> bool {
        self.mounts.iter().any(|corners| self.is_clear(base, corners, heading))
    }

    /// True if a footprint with these corners relative to the base is clear of all solids.
    fn is_clear(&self, base: Point2, corners: &[Vector2; 4], heading: f64) -> bool {
        let corners = corners.map(|corner| base + rotate(corner, heading));
        // The reduced footprint does not contain the base, and a thin wall could separate them.
        let middle = middle_of(&corners);
        self.is_connected(middle) && self.outlines.are_clear_of(&corners) && self.outlines.is_open(base, middle)
    }

    /// True if the middle of the footprint may come from the start to a point.
    fn is_connected(&self, middle: Point2) -> bool {
        self.enclosure().is_none_or(|enclosure| enclosure.admits(middle))
    }

    /// The ground that the platform cannot leave, if objects enclose it.
    fn enclosure(&self) -> Option<&Enclosure> {
        let find = || {
            let middle = |corners: &[Vector2; 4]| middle_of(&corners.map(Point2::from)).coords.norm();
            let arm = self.mounts.iter().map(middle).fold(0.0, f64::max);
            Enclosure::new(self.start?, self.rig, &self.outlines, self.margin, arm)
        };
        self.enclosure.get_or_init(find).as_ref()
    }
}

/// Moves all sides of a convex polygon, given counter-clockwise, inwards by `margin` (m). A polygon that is too thin
/// becomes a point.
fn shrunk(corners: [Vector2; 4], margin: f64) -> [Vector2; 4] {
    let middle = corners.iter().fold(Vector2::zeros(), |sum, corner| sum + corner / 4.0);
    let inwards = |side: usize| perpendicular((corners[(side + 1) % 4] - corners[side]).normalize());
    let widest = (0..4).map(|side| inwards(side).dot(&(middle - corners[side]))).fold(f64::INFINITY, f64::min);
    if widest <= margin {
        return [middle; 4];
    }
    [0, 1, 2, 3].map(|corner| {
        let (before, after) = (inwards((corner + 3) % 4), inwards(corner));
        // The intersection of both moved sides.
        corners[corner] + margin / (1.0 + before.dot(&after)) * (before + after)
    })
}

fn place((column, row): Node) -> Point2 {
    Point2::new(column as f64 * CELL_SIZE, row as f64 * CELL_SIZE)
}

#[expect(clippy::cast_possible_truncation, reason = "a scene is some metres wide")]
fn node_at(point: Point2) -> Node {
    ((point.x / CELL_SIZE).floor() as i64, (point.y / CELL_SIZE).floor() as i64)
}

/// A path to a node. The order is reversed for a priority queue of the shortest paths.
#[derive(PartialEq)]
struct SearchPath {
    length: f64,
    node: Node,
}

impl Eq for SearchPath {}

impl Ord for SearchPath {
    fn cmp(&self, other: &Self) -> Ordering {
        other.length.total_cmp(&self.length)
    }
}

impl PartialOrd for SearchPath {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}
