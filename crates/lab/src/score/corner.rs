//! Accuracy and cost of corners.

use std::f64::consts::PI;

use rstar::RTree;
use rstar::primitives::GeomWithData;

use crate::run::Trace;
use vibrissa_runtime::math;
use vibrissa_world::geometry::{
    Contour, ContourSet, Corner, Point2, TreePoint, Vector2, perpendicular, rotate, tree_point, turn_between,
};

use super::tip::{valid_tips, whiskers};
use super::{Moments, Statistics, excursions};

/// The smallest change of direction (rad) of a sharp corner, 20°.
pub const SHARP: f64 = PI / 9.0;

/// The range of distances from a corner along the outline (m) whose tips determine a side. Closer to the corner, an
/// estimate with an error of millimetres does not separate the two sides.
pub const SIDE: (f64, f64) = (0.005, 0.03);

/// The share of the length of a short side that is excluded at either end.
const SHORT_SIDE: f64 = 0.2;

/// The smallest number of tips on a side. They must also cover at least this share of the side.
const MIN_TIPS: usize = 3;
const MIN_REACH: f64 = 0.3;

/// The largest number of tips that are used for a side, because the work grows quadratically.
const MAX_TIPS: usize = 300;

/// Tolerance for the rounding of distances (m).
const ROUNDING: f64 = 1e-9;

/// The smallest angle (rad) at which two lines have a well-defined intersection.
const MIN_ANGLE: f64 = 0.1;

/// The largest distance from a corner (m) at which a lost contact is attributed to it.
const MAX_CLAIM: f64 = 0.03;

/// A sharp corner of the exact outline that was traced on both sides.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TracedCorner {
    /// The exact corner.
    pub corner: Corner,
    /// The estimated corner (m, world frame), which is the intersection of its two estimated sides.
    ///
    /// A side is a line through the tips recorded [near the corner](SIDE), by the median slope of all pairs of tips. On
    /// a curved outline, the line is fitted to the offsets of the tips from the outline. It represents the displacement
    /// and the rotation of the estimate.
    pub place_world: Point2,
    /// The difference of the estimated and the exact corner angle (rad), positive if the estimate turns more.
    pub turn_error: f64,
    /// The distance (m) between the corner and its first edge point, the last tip before the contact was lost. `None`
    /// if it was not lost at this corner.
    pub edge: Option<f64>,
    /// The longest time (s) between loss and recovery of the contact at this corner, 0 if it was not lost.
    pub time: f64,
    /// The longest path of the platform's centre of mass in such a time (m).
    pub path: f64,
}

impl TracedCorner {
    /// The distance (m) between the estimated and the exact corner.
    #[must_use]
    pub fn place_error(&self) -> f64 {
        (self.place_world - self.corner.point).norm()
    }
}

/// The sharp corners of `outlines` that a run traced on both sides, in the order of the outlines, with the total number
/// of sharp corners. The tips of all whiskers and of all passes count.
#[must_use]
pub fn traced_corners(trace: &Trace, outlines: &ContourSet) -> (Vec<TracedCorner>, usize) {
    let outlines: Vec<&Contour> = outlines.contours().collect();
    let sharp: Vec<Vec<Corner>> = outlines.iter().map(|outline| sharp(outline)).collect();
    let count = sharp.iter().map(Vec::len).sum();
    if count == 0 {
        return (Vec::new(), 0);
    }
    let felt = tips_by_outline(trace, &outlines, &sharp);
    let all =
        sharp.iter().enumerate().flat_map(|(outline, corners)| corners.iter().map(move |corner| (outline, *corner)));
    let all: Vec<(usize, Corner)> = all.collect();
    let costs = costs(trace, &all);
    let numbers = sharp.iter().flat_map(|corners| 0..corners.len());
    let traced = all.iter().zip(numbers).zip(costs).filter_map(|((&(index, corner), number), cost)| {
        let Cost { edge, time, path } = cost;
        let (place_world, turn_error) = reconstructed(outlines[index], &sharp[index], number, &felt[index])?;
        Some(TracedCorner { corner, place_world, turn_error, edge, time, path })
    });
    (traced.collect(), count)
}

/// The cost of a corner, as in [`TracedCorner`].
#[derive(Clone, Copy, Default)]
struct Cost {
    edge: Option<f64>,
    time: f64,
    path: f64,
}

/// The cost of every corner. An excursion is attributed to the corner nearest to its beginning.
fn costs(trace: &Trace, corners: &[(usize, Corner)]) -> Vec<Cost> {
    let mut costs = vec![Cost::default(); corners.len()];
    let tree = tree_of(corners.iter().map(|(_, corner)| corner));
    for excursion in excursions(trace) {
        let from_edge = |index: usize| (index, (corners[index].1.point - excursion.edge_world).norm());
        let near = near(&tree, excursion.edge_world, MAX_CLAIM).map(from_edge);
        let nearest = near.min_by(|(one, a), (other, b)| a.total_cmp(b).then(one.cmp(other)));
        if let Some((index, distance)) = nearest.filter(|&(_, distance)| distance <= MAX_CLAIM) {
            let cost = &mut costs[index];
            cost.edge = cost.edge.or(Some(distance));
            cost.time = cost.time.max(excursion.time);
            cost.path = cost.path.max(excursion.path);
        }
    }
    costs
}

fn sharp(outline: &Contour) -> Vec<Corner> {
    outline.corners().into_iter().filter(|corner| corner.turn.abs() > SHARP).collect()
}

/// The positions of corners, with their indices.
fn tree_of<'c>(corners: impl Iterator<Item = &'c Corner>) -> RTree<GeomWithData<TreePoint, usize>> {
    let places = corners.enumerate().map(|(index, corner)| GeomWithData::new(tree_point(corner.point), index));
    RTree::bulk_load(places.collect())
}

/// The indices of the corners within a distance (m) of a point, in no particular order. Some may be farther by a rounding
/// error.
fn near(tree: &RTree<GeomWithData<TreePoint, usize>>, point: Point2, distance: f64) -> impl Iterator<Item = usize> {
    let reach = distance + ROUNDING;
    tree.locate_within_distance(tree_point(point), reach * reach).map(|corner| corner.data)
}

/// A tip relative to its nearest outline: arc length (m), and offset to the right (m).
type OutlineTip = (f64, f64);

/// The tips at an outline.
struct OutlineTips {
    tips: Vec<OutlineTip>,
    /// The indices of the tips, by arc length.
    order: Vec<usize>,
}

impl OutlineTips {
    fn new(tips: Vec<OutlineTip>) -> Self {
        let mut order: Vec<usize> = (0..tips.len()).collect();
        order.sort_by(|&one, &other| tips[one].0.total_cmp(&tips[other].0));
        Self { tips, order }
    }

    /// The tips whose arc lengths (m) are between these two, in the order of the tips. The arc length of an outline is
    /// periodic if it has a `period` (m).
    fn between(&self, start: f64, end: f64, period: Option<f64>) -> impl Iterator<Item = OutlineTip> {
        let within = |start: f64, end: f64| {
            let position = |arc_length: f64| self.order.partition_point(|&tip| self.tips[tip].0 < arc_length);
            self.order.get(position(start)..position(end.next_up())).unwrap_or_default()
        };
        let shifted = period.into_iter().flat_map(|period| [-period, period]);
        let found = std::iter::once(0.0).chain(shifted).flat_map(|shift| within(start + shift, end + shift));
        let mut found: Vec<usize> = found.copied().collect();
        found.sort_unstable();
        found.dedup();
        found.into_iter().map(|tip| self.tips[tip])
    }
}

/// The tips of a run that may belong to a side of a `sharp` corner, grouped by their nearest outline.
fn tips_by_outline(trace: &Trace, outlines: &[&Contour], sharp: &[Vec<Corner>]) -> Vec<OutlineTips> {
    let mut felt = vec![Vec::new(); outlines.len()];
    let trees: Vec<_> = sharp.iter().map(|corners| tree_of(corners.iter())).collect();
    for (_, tip) in whiskers(trace).flat_map(|whisker| valid_tips(trace, whisker)) {
        let distances = outlines.iter().map(|outline| outline.distance(tip)).enumerate();
        let Some((index, distance)) = distances.min_by(|(_, a), (_, b)| a.total_cmp(b)) else { continue };
        // The straight distance is at most the distance along the outline.
        let reach = SIDE.1 + distance + ROUNDING;
        if near(&trees[index], tip, reach).any(|corner| (tip - sharp[index][corner].point).norm() <= reach) {
            felt[index].push((outlines[index].nearest(tip).arc_length, outlines[index].signed_distance(tip)));
        }
    }
    felt.into_iter().map(OutlineTips::new).collect()
}

/// The position of the estimated corner with this `number`, and its excess angle. `None` if it was not traced on both sides.
fn reconstructed(outline: &Contour, sharp: &[Corner], number: usize, felt: &OutlineTips) -> Option<(Point2, f64)> {
    let corner = sharp.get(number)?;
    let outgoing = outline.tangent_at(corner.arc_length);
    let incoming = rotate(outgoing, -corner.turn);
    let before = Line::fitted(outline, sharp, number, felt, incoming, -1.0)?;
    let after = Line::fitted(outline, sharp, number, felt, outgoing, 1.0)?;
    let turn = math::atan2(before.direction.perp(&after.direction), before.direction.dot(&after.direction));
    let sine = math::sin(turn);
    if sine.abs() < math::sin(MIN_ANGLE) {
        return None;
    }
    let along = (after.point - before.point).perp(&after.direction) / sine;
    let extra = turn_between(corner.turn, turn);
    Some((before.point + along * before.direction, extra * corner.turn.signum()))
}

/// An estimated side of a corner.
struct Line {
    point: Point2,
    /// A unit vector.
    direction: Vector2,
}

impl Line {
    /// Fits the side before (`way` −1) or after (`way` +1) the corner with this `number`. The exact outline has the
    /// direction `tangent` there.
    fn fitted(
        outline: &Contour,
        sharp: &[Corner],
        number: usize,
        felt: &OutlineTips,
        tangent: Vector2,
        way: f64,
    ) -> Option<Self> {
        let corner = sharp.get(number)?;
        let period = outline.is_closed().then(|| outline.length());
        // Arc length from the corner in the direction of the side.
        let from_corner = |arc_length: f64| {
            let along = way * (arc_length - corner.arc_length);
            period.map_or(along, |period| along.rem_euclid(period))
        };
        let end = if outline.is_closed() || way > 0.0 { outline.length() } else { 0.0 };
        let to_end = if outline.is_closed() { end } else { from_corner(end) };
        // The corners are in the order of their arc lengths.
        let (after, before) = (number + 1, number.checked_sub(1));
        let next = match (way > 0.0, outline.is_closed()) {
            (true, true) => sharp.get(after % sharp.len()),
            (true, false) => sharp.get(after),
            (false, true) => before.map_or(sharp.last(), |before| sharp.get(before)),
            (false, false) => before.and_then(|before| sharp.get(before)),
        };
        let to_next = next.map(|next| from_corner(next.arc_length)).filter(|&along| along > 0.0);
        let length = to_next.map_or(to_end, |to_next| to_end.min(to_next));
        let nearest = SIDE.0.min(SHORT_SIDE * length);
        let farthest = SIDE.1.min(length - nearest);
        let (mut along, mut off) = (Vec::new(), Vec::new());
        let far = corner.arc_length + way * farthest;
        let [start, end] = [far.min(corner.arc_length) - ROUNDING, far.max(corner.arc_length) + ROUNDING];
        for (arc_length, offset) in felt.between(start, end, period) {
            let distance = from_corner(arc_length);
            if (nearest..=farthest).contains(&distance) {
                along.push(way * distance);
                off.push(offset);
            }
        }
        let (least, most) = along.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), &s| (a.min(s), b.max(s)));
        if along.len() < MIN_TIPS || most - least < MIN_REACH * (farthest - nearest) {
            return None;
        }
        let (offset, slope) = line(&along, &off)?;
        let right = -perpendicular(tangent);
        Some(Self { point: corner.point + offset * right, direction: (tangent + slope * right).normalize() })
    }
}

/// Fits a line through (`x`, `y`) and returns its value at 0 and its slope. The Theil-Sen estimator uses the median
/// slope of all pairs and the median intercept. It is robust to a few outliers, which the error metrics already show.
/// `None` without two different `x`.
fn line(x: &[f64], y: &[f64]) -> Option<(f64, f64)> {
    let stride = x.len() / MAX_TIPS + 1;
    let points: Vec<_> = x.iter().zip(y).step_by(stride).collect();
    let slope = |(index, (x, y)): (usize, &(&f64, &f64))| {
        let slopes = points[..index].iter().map(|(other_x, other_y)| (*y - *other_y) / (*x - *other_x));
        slopes.filter(|slope| slope.is_finite()).collect::<Vec<_>>()
    };
    let slope = Statistics::of(points.iter().enumerate().flat_map(slope).collect())?.percentile(50.0);
    let rest = Statistics::of(points.iter().map(|(x, y)| *y - slope * *x).collect())?;
    Some((rest.percentile(50.0), slope))
}

/// The figures of all corners of a run. A figure is `None` if no corner has it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CornerFigures {
    /// The number of sharp corners.
    pub count: usize,
    /// The number of sharp corners that were traced on both sides.
    pub traced: usize,
    /// Distances of the estimated corners from the exact ones (m).
    pub place: Option<CornerStatistics>,
    /// Absolute differences of the corner angles (rad).
    pub turn: Option<CornerStatistics>,
    /// Distances of the edge points from their corners (m), for corners at which the contact was lost.
    pub edge: Option<CornerStatistics>,
    /// Times of the corners (s).
    pub time: Option<CornerStatistics>,
    /// Paths of the platform at the corners (m).
    pub path: Option<CornerStatistics>,
}

/// A figure over all corners.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CornerStatistics {
    /// Mean and standard deviation.
    pub moments: Moments,
    /// The largest value.
    pub max: f64,
}

impl CornerFigures {
    /// The figures of a run. `None` if the outlines have no sharp corner.
    #[must_use]
    pub fn new(trace: &Trace, outlines: &ContourSet) -> Option<Self> {
        let (traced, count) = traced_corners(trace, outlines);
        let figure = |of: fn(&TracedCorner) -> Option<f64>| {
            let statistics = Statistics::of(traced.iter().filter_map(of).collect())?;
            let moments = Moments { mean: statistics.mean(), std: statistics.std() };
            Some(CornerStatistics { moments, max: statistics.max() })
        };
        (count > 0).then(|| Self {
            count,
            traced: traced.len(),
            place: figure(|corner| Some(corner.place_error())),
            turn: figure(|corner| Some(corner.turn_error.abs())),
            edge: figure(|corner| corner.edge),
            time: figure(|corner| Some(corner.time)),
            path: figure(|corner| Some(corner.path)),
        })
    }
}
