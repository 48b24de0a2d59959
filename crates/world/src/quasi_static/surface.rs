//! The surfaces that whiskers and the platform can touch.

use std::f64::consts::PI;

use rstar::{AABB, RTree, RTreeObject};

use crate::geometry::{self, BoundingBox, Contour, Piece, Point2, TreePoint, Vector2, perpendicular, tree_point, unit};
use crate::solid::Solid;

/// The outlines of all solids as facets, with a spatial index.
#[derive(Debug)]
pub(super) struct Surfaces {
    outlines: Vec<Contour>,
    facets: Vec<Facet>,
    tree: RTree<Leaf>,
}

/// A piece of an outline. The solid is on its left.
#[derive(Debug, Clone)]
pub(super) struct Facet {
    curve: CarrierCurve,
    /// The extension (m) at the start and at the end. Behind a concave corner, a facet extends so far that a point
    /// between both sides faces either one.
    extension: [f64; 2],
    /// The distance (m) from the start and from the end within which a known outside point is retained at a concave
    /// corner. Such a point may be behind the other side for a moment.
    retention: [f64; 2],
    pub(super) ends: [Point2; 2],
    bounds: BoundingBox,
    /// The index of the following facet.
    pub(super) next: usize,
    /// The junction with the following facet.
    pub(super) junction: Junction,
    /// True if very many facets are near it.
    pub(super) is_crowded: bool,
}

/// The junction of two pieces of an outline.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Junction {
    /// The tangent is continuous.
    Smooth,
    /// The junction is a convex corner.
    Convex(Corner),
    /// The junction is a concave corner.
    Concave,
}

/// A convex corner with the tangents of the outline before and after it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Corner {
    pub(super) point: Point2,
    incoming: Vector2,
    outgoing: Vector2,
}

/// The geometry of a facet, prepared for fast queries.
#[derive(Debug, Clone, Copy)]
enum CarrierCurve {
    Flat {
        start: Point2,
        tangent: Vector2,
        length: f64,
    },
    /// An arc. `sense` is +1 if it is convex and −1 if it is concave.
    Round {
        centre: Point2,
        radius: f64,
        sense: f64,
        from: Vector2,
        to: Vector2,
        extent: Extent,
    },
}

/// The angular extent of an arc.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Extent {
    UpToHalf,
    MoreThanHalf,
    Whole,
}

/// The projection of a point onto a facet.
#[derive(Debug, Clone, Copy)]
pub(super) struct Projection {
    /// The outward normal, a unit vector in the world frame.
    pub(super) normal: Vector2,
    /// The signed distance of the point (m), negative inside.
    pub(super) height: f64,
    /// The curvature of the circle about the centre of curvature through the point (1/m), positive at a convex arc.
    pub(super) curvature: f64,
}

/// The extension (m) of a facet at a smooth junction. It prevents a gap between neighbouring facets.
const JUNCTION_OVERLAP: f64 = 1e-8;
/// The largest extension (m) at a concave corner. It is longer than the motion of a whisker in a sample.
const MAX_EXTENSION: f64 = 5e-3;

/// A facet is crowded if so many before it and as many after it are on a stretch of the outline of this length (m).
const CROWD: usize = 500;
const CROWDED: f64 = 0.2;

impl Surfaces {
    pub(super) fn new(solids: &[Solid]) -> Self {
        let mut facets = Vec::new();
        for outline in solids.iter().map(Solid::surface) {
            let (first, pieces) = (facets.len(), outline.pieces());
            let corners = corners_by_piece(outline);
            let is_crowded = crowded(pieces);
            for (index, piece) in pieces.iter().enumerate() {
                let following = (index + 1) % pieces.len();
                let next = &pieces[following];
                let junction = match corners[following] {
                    Some(corner) if corner.turn > 0.0 => Junction::Convex(Corner {
                        point: corner.point,
                        incoming: piece.tangent_at(piece.length()),
                        outgoing: next.tangent_at(0.0),
                    }),
                    Some(_) => Junction::Concave,
                    None => Junction::Smooth,
                };
                facets.push(Facet {
                    curve: CarrierCurve::of(piece),
                    extension: [JUNCTION_OVERLAP; 2],
                    retention: [0.0; 2],
                    ends: [piece.start(), piece.end()],
                    bounds: piece.bounding_box(),
                    next: first + following,
                    junction,
                    is_crowded: is_crowded[index],
                });
            }
        }
        for index in 0..facets.len() {
            let next = facets[index].next;
            if facets[index].junction == Junction::Concave {
                // The extension ends where the projection of the other side ends.
                let [own, others] = [&facets[index], &facets[next]].map(|facet| facet.ends[1] - facet.ends[0]);
                let folded = own.dot(&others) / (own.norm() * others.norm()).max(f64::MIN_POSITIVE);
                let share = 0.5 * folded.max(0.0);
                facets[index].extension[1] = (share * others.norm()).clamp(JUNCTION_OVERLAP, MAX_EXTENSION);
                facets[next].extension[0] = (share * own.norm()).clamp(JUNCTION_OVERLAP, MAX_EXTENSION);
                // Within this distance of the corner, no point can come around the far end of either side.
                let retention = own.norm().min(others.norm()).min(MAX_EXTENSION);
                facets[index].retention[1] = retention;
                facets[next].retention[0] = retention;
            }
        }
        let leaf = |(index, facet): (usize, &Facet)| Leaf { index, bounds: facet.bounds };
        let tree = RTree::bulk_load(facets.iter().enumerate().map(leaf).collect());
        Self { outlines: solids.iter().map(|solid| solid.surface().clone()).collect(), facets, tree }
    }

    /// Returns the penetration depth of a point (m), negative outside of all solids.
    pub(super) fn depth(&self, point: Point2) -> f64 {
        self.outlines.iter().map(|outline| -outline.signed_distance(point)).fold(f64::NEG_INFINITY, f64::max)
    }

    pub(super) fn facet(&self, index: usize) -> &Facet {
        &self.facets[index]
    }

    /// Returns the facets that intersect a box widened by `margin` (m), in no particular order.
    pub(super) fn near(&self, bounds: BoundingBox, margin: f64) -> impl Iterator<Item = (usize, &Facet)> {
        let margin = Vector2::repeat(margin);
        let (min, max) = (bounds.min - margin, bounds.max + margin);
        let wide = AABB::from_corners((min.x, min.y), (max.x, max.y));
        self.tree.locate_in_envelope_intersecting(wide).map(|leaf| (leaf.index, &self.facets[leaf.index]))
    }
}

/// For every piece of an outline, the corner at its start.
fn corners_by_piece(outline: &Contour) -> Vec<Option<geometry::Corner>> {
    // The corners are in the order of the pieces.
    let mut corners = outline.corners().into_iter().peekable();
    outline.pieces().iter().map(|piece| corners.next_if(|corner| corner.point == piece.start())).collect()
}

/// For every piece of a closed outline, true if it is crowded.
fn crowded(pieces: &[Piece]) -> Vec<bool> {
    let count = pieces.len();
    if count <= 2 * CROWD {
        return vec![false; count];
    }
    let mut stretch: f64 = pieces[..2 * CROWD].iter().map(Piece::length).sum();
    let mut crowded = vec![false; count];
    for first in 0..count {
        crowded[(first + CROWD) % count] = stretch < CROWDED;
        stretch += pieces[(first + 2 * CROWD) % count].length() - pieces[first].length();
    }
    crowded
}

impl Facet {
    /// Projects a point onto the facet. Returns `None` if the point is beyond an end.
    pub(super) fn project(&self, point: Point2) -> Option<Projection> {
        let is_beside = match self.curve {
            CarrierCurve::Flat { start, tangent, length } => {
                let along = (point - start).dot(&tangent);
                along >= -self.extension[0] && along <= length + self.extension[1]
            }
            CarrierCurve::Round { centre, .. } => self.spans(point - centre),
        };
        if is_beside { self.project_on_carrier(point) } else { None }
    }

    /// Projects a point that has been outside of this facet. The point may be behind the other side of a concave
    /// corner.
    pub(super) fn project_retained(&self, point: Point2) -> Option<Projection> {
        self.project(point).or_else(|| {
            let mut corners = self.ends.iter().zip(self.retention);
            corners
                .any(|(end, retention)| (point - end).norm() < retention)
                .then(|| self.project_on_carrier(point))
                .flatten()
        })
    }

    /// True if a point is on the outer side of the facet's line or circle.
    pub(super) fn is_outside(&self, point: Point2) -> bool {
        self.project_on_carrier(point).is_some_and(|projection| projection.height > 0.0)
    }

    /// Projects a point onto the line or circle of the facet.
    fn project_on_carrier(&self, point: Point2) -> Option<Projection> {
        match self.curve {
            CarrierCurve::Flat { start, tangent, .. } => {
                let normal = -perpendicular(tangent);
                Some(Projection { normal, height: (point - start).dot(&normal), curvature: 0.0 })
            }
            CarrierCurve::Round { centre, radius, sense, .. } => {
                let outward = point - centre;
                let distance = outward.norm();
                let height = sense * (distance - radius);
                (distance > 0.0).then(|| Projection {
                    normal: sense / distance * outward,
                    height,
                    curvature: sense / distance,
                })
            }
        }
    }

    /// The points at which a step from one point to another crosses the facet: the share of the step, and the outward
    /// normal.
    pub(super) fn crossings(&self, from: Point2, to: Point2) -> impl Iterator<Item = (f64, Vector2)> {
        let step = to - from;
        let shares = match self.curve {
            CarrierCurve::Flat { start, tangent, .. } => {
                [tangent.perp(&(start - from)) / tangent.perp(&step), f64::NAN]
            }
            CarrierCurve::Round { centre, radius, .. } => {
                let (square, from_centre) = (step.norm_squared(), from - centre);
                let half = step.dot(&from_centre) / square;
                let root = (half * half - (from_centre.norm_squared() - radius * radius) / square).sqrt();
                [-half - root, -half + root]
            }
        };
        let is_on_step = |share: &f64| (0.0..=1.0).contains(share);
        let crossing = move |share: f64| Some((share, self.project(from + share * step)?.normal));
        shares.into_iter().filter(is_on_step).filter_map(crossing)
    }

    /// The centre and the radius (m) of a convex arc. `None` for other facets.
    pub(super) fn bulge(&self) -> Option<(Point2, f64)> {
        match self.curve {
            CarrierCurve::Round { centre, radius, sense: 1.0, .. } => Some((centre, radius)),
            _ => None,
        }
    }

    /// True if an arc contains the direction `outward` from its centre. Always false for a straight facet.
    pub(super) fn spans(&self, outward: Vector2) -> bool {
        let CarrierCurve::Round { radius, sense, from, to, extent, .. } = self.curve else { return false };
        // The distances (m) by which the ray is after the start and before the end.
        let [start, end] = self.extension.map(|extension| -extension * outward.norm() / radius);
        let (after, before) = (sense * from.perp(&outward) >= start, sense * outward.perp(&to) >= end);
        match extent {
            Extent::UpToHalf => after && before,
            Extent::MoreThanHalf => after || before,
            Extent::Whole => true,
        }
    }

    /// Returns the distance (m) of a point from the facet.
    pub(super) fn distance(&self, point: Point2) -> f64 {
        match (self.curve, self.project(point)) {
            (_, Some(projection)) => projection.height.abs(),
            // All points of the arc are equally far from the centre.
            (CarrierCurve::Round { centre, radius, .. }, None) if point == centre => radius,
            _ => self.ends.iter().map(|end| (point - end).norm()).fold(f64::INFINITY, f64::min),
        }
    }
}

impl CarrierCurve {
    fn of(piece: &Piece) -> Self {
        match piece {
            Piece::Segment(segment) => {
                Self::Flat { start: segment.start, tangent: segment.tangent(), length: segment.length() }
            }
            Piece::Arc(arc) => {
                let extent = if arc.sweep.abs() > 2.0 * PI - 1e-9 {
                    Extent::Whole
                } else if arc.sweep.abs() > PI {
                    Extent::MoreThanHalf
                } else {
                    Extent::UpToHalf
                };
                Self::Round {
                    centre: arc.centre,
                    radius: arc.radius,
                    sense: arc.sweep.signum(),
                    from: unit(arc.start_angle),
                    to: unit(arc.start_angle + arc.sweep),
                    extent,
                }
            }
        }
    }
}

impl Corner {
    /// True if the corner angle exceeds 5°. Corners of polygons usually do, and corners of approximated curves usually
    /// do not.
    pub(super) fn is_sharp(&self) -> bool {
        const COS_5_DEG: f64 = 0.9962;
        self.incoming.dot(&self.outgoing) < COS_5_DEG
    }

    /// Returns the side of a line through the corner on which all solid material is: +1 towards `left`, −1 away from
    /// it. `None` if there is material on both sides, or if the line is tangent.
    pub(super) fn side_of(&self, left: Vector2) -> Option<f64> {
        let (behind, before) = (-self.incoming.dot(&left), self.outgoing.dot(&left));
        (behind * before > 0.0).then(|| before.signum())
    }

    /// Returns the side of a link on which the corner is, if the link points into the solid along `tangent` and its end is
    /// past the corner: +1 towards `left`, −1 away from it. `None` if the end can be past the corner on either side.
    pub(super) fn side_past(&self, tangent: Vector2, left: Vector2) -> Option<f64> {
        if self.incoming.perp(&tangent) <= 0.0 || self.outgoing.perp(&tangent) <= 0.0 {
            return None;
        }
        // An end past the corner is outside only above a facet that descends along the link.
        let facets = [-self.incoming, self.outgoing];
        match facets.map(|facet| facet.dot(&tangent) > 0.0) {
            [true, false] => Some(-facets[0].dot(&left).signum()),
            [false, true] => Some(-facets[1].dot(&left).signum()),
            _ => None,
        }
    }

    /// Projects a point onto the corner. Returns `None` if a neighbouring facet is nearer.
    pub(super) fn project(&self, point: Point2) -> Option<Projection> {
        let outward = point - self.point;
        let height = outward.norm();
        let faces = outward.dot(&self.incoming) > 0.0 && outward.dot(&self.outgoing) < 0.0 && height > 0.0;
        faces.then(|| Projection { normal: outward / height, height, curvature: height.recip() })
    }
}

/// An entry of the spatial index.
#[derive(Debug)]
struct Leaf {
    index: usize,
    bounds: BoundingBox,
}

impl RTreeObject for Leaf {
    type Envelope = AABB<TreePoint>;

    fn envelope(&self) -> Self::Envelope {
        AABB::from_corners(tree_point(self.bounds.min), tree_point(self.bounds.max))
    }
}
