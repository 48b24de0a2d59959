//! The surfaces that whiskers and the platform touch.

use std::f64::consts::PI;

use rstar::{AABB, RTree, RTreeObject};

use crate::geometry::{BoundingBox, Contour, Piece, Point2, Vector2, perpendicular, unit};
use crate::solid::Solid;

/// The outlines of all solids, piece by piece.
#[derive(Debug)]
pub(super) struct Surfaces {
    outlines: Vec<Contour>,
    facets: Vec<Facet>,
    tree: RTree<Leaf>,
}

/// A piece of an outline. What is solid is on its left.
#[derive(Debug, Clone)]
pub(super) struct Facet {
    form: Form,
    /// How far (m) it counts on beyond its start and its end: beyond a corner that points inwards, where what comes along the one
    /// side meets the other.
    beyond: [f64; 2],
    /// How far (m) from its start and from its end it counts on, beyond such a corner, for what is known to be outside of it: what the
    /// other side is to hold may come in behind that for a moment, and must not lose this one there.
    kept: [f64; 2],
    ends: [Point2; 2],
    bounds: BoundingBox,
    /// The piece after this one.
    pub(super) next: usize,
    /// How it meets that.
    pub(super) joint: Joint,
}

/// How two pieces of an outline meet.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Joint {
    /// Without a corner.
    Smooth,
    /// In a corner that sticks out.
    Convex(Corner),
    /// In a corner that points inwards.
    Concave,
}

/// A corner that sticks out, with the directions in which the outline comes to it and leaves it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Corner {
    pub(super) point: Point2,
    into: Vector2,
    out: Vector2,
}

/// A piece, as quick to ask as can be.
#[derive(Debug, Clone, Copy)]
enum Form {
    Flat {
        start: Point2,
        tangent: Vector2,
        length: f64,
    },
    /// An arc; `sense` is +1 if it bulges outwards, −1 if it is hollow.
    Round {
        centre: Point2,
        radius: f64,
        sense: f64,
        from: Vector2,
        to: Vector2,
        extent: Extent,
    },
}

/// How much of its circle an arc is.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Extent {
    UpToHalf,
    MoreThanHalf,
    Whole,
}

/// The point of a facet that faces another point.
#[derive(Debug, Clone, Copy)]
pub(super) struct Foot {
    /// Outwards, a unit vector.
    pub(super) normal: Vector2,
    /// How far the point is outside (m); negative inside.
    pub(super) height: f64,
    /// What the point's circle about the centre of curvature curves the gap by (1/m): above 0 about a bulge.
    pub(super) curvature: f64,
}

/// How far (m) a facet reaches beyond a smooth joint, so that there is no crack between it and the next.
const OVERLAP: f64 = 1e-8;
/// How far (m) it does at most beyond a corner that points inwards: more than a whisker moves in a sample.
const BEYOND: f64 = 5e-3;

impl Surfaces {
    pub(super) fn new(solids: &[Solid]) -> Self {
        let mut facets = Vec::new();
        for outline in solids.iter().map(Solid::outline) {
            let (first, pieces, corners) = (facets.len(), outline.pieces(), outline.corners());
            for (index, piece) in pieces.iter().enumerate() {
                let following = (index + 1) % pieces.len();
                let next = &pieces[following];
                let corner = corners.iter().find(|corner| corner.point == next.start());
                let joint = match corner {
                    Some(corner) if corner.turn > 0.0 => Joint::Convex(Corner {
                        point: corner.point,
                        into: piece.tangent_at(piece.length()),
                        out: next.tangent_at(0.0),
                    }),
                    Some(_) => Joint::Concave,
                    None => Joint::Smooth,
                };
                facets.push(Facet {
                    form: Form::of(piece),
                    beyond: [OVERLAP; 2],
                    kept: [0.0; 2],
                    ends: [piece.start(), piece.end()],
                    bounds: piece.bounding_box(),
                    next: first + following,
                    joint,
                });
            }
        }
        for index in 0..facets.len() {
            let next = facets[index].next;
            if facets[index].joint == Joint::Concave {
                // No farther than the other side stands out over this one.
                let [own, others] = [&facets[index], &facets[next]].map(|facet| facet.ends[1] - facet.ends[0]);
                let folded = own.dot(&others) / (own.norm() * others.norm()).max(f64::MIN_POSITIVE);
                let share = 0.5 * folded.max(0.0);
                facets[index].beyond[1] = (share * others.norm()).clamp(OVERLAP, BEYOND);
                facets[next].beyond[0] = (share * own.norm()).clamp(OVERLAP, BEYOND);
                // So near to the corner nothing comes round the far end of either side.
                let kept = own.norm().min(others.norm()).min(BEYOND);
                facets[index].kept[1] = kept;
                facets[next].kept[0] = kept;
            }
        }
        let leaf = |(index, facet): (usize, &Facet)| Leaf { index, bounds: facet.bounds };
        let tree = RTree::bulk_load(facets.iter().enumerate().map(leaf).collect());
        Self { outlines: solids.iter().map(|solid| solid.outline().clone()).collect(), facets, tree }
    }

    /// How deep (m) in a solid a point is; below 0 outside of all.
    pub(super) fn depth(&self, point: Point2) -> f64 {
        self.outlines.iter().map(|outline| -outline.signed_distance(point)).fold(f64::NEG_INFINITY, f64::max)
    }

    pub(super) fn facet(&self, index: usize) -> &Facet {
        &self.facets[index]
    }

    /// The facets that come into a box, widened by `margin` (m), in no particular order.
    pub(super) fn near(&self, bounds: BoundingBox, margin: f64) -> impl Iterator<Item = (usize, &Facet)> {
        let margin = Vector2::repeat(margin);
        let (min, max) = (bounds.min - margin, bounds.max + margin);
        let wide = AABB::from_corners([min.x, min.y], [max.x, max.y]);
        self.tree.locate_in_envelope_intersecting(wide).map(|leaf| (leaf.index, &self.facets[leaf.index]))
    }
}

impl Facet {
    /// The foot of a point on this facet, if the point is beside it and not beyond an end.
    pub(super) fn foot(&self, point: Point2) -> Option<Foot> {
        let is_beside = match self.form {
            Form::Flat { start, tangent, length } => {
                let along = (point - start).dot(&tangent);
                along >= -self.beyond[0] && along <= length + self.beyond[1]
            }
            Form::Round { centre, .. } => self.spans(point - centre),
        };
        if is_beside { self.continued(point) } else { None }
    }

    /// The same for a point that is known to have been outside of this facet: also where it has come in behind the other side of a
    /// corner that points inwards.
    pub(super) fn foot_of_known(&self, point: Point2) -> Option<Foot> {
        self.foot(point).or_else(|| {
            let mut corners = self.ends.iter().zip(self.kept);
            corners.any(|(end, kept)| (point - end).norm() < kept).then(|| self.continued(point)).flatten()
        })
    }

    /// Whether a point is on the outer side of the line or the circle that this facet is a part of.
    pub(super) fn is_outside(&self, point: Point2) -> bool {
        self.continued(point).is_some_and(|foot| foot.height > 0.0)
    }

    /// The foot of a point on the line or the circle that this facet is a part of.
    fn continued(&self, point: Point2) -> Option<Foot> {
        match self.form {
            Form::Flat { start, tangent, .. } => {
                let normal = -perpendicular(tangent);
                Some(Foot { normal, height: (point - start).dot(&normal), curvature: 0.0 })
            }
            Form::Round { centre, radius, sense, .. } => {
                let outward = point - centre;
                let distance = outward.norm();
                let height = sense * (distance - radius);
                (distance > 0.0).then(|| Foot {
                    normal: sense / distance * outward,
                    height,
                    curvature: sense / distance,
                })
            }
        }
    }

    /// The centre and the radius of a facet that bulges outwards.
    pub(super) fn bulge(&self) -> Option<(Point2, f64)> {
        match self.form {
            Form::Round { centre, radius, sense: 1.0, .. } => Some((centre, radius)),
            _ => None,
        }
    }

    /// Whether an arc comes past the direction `outward` from its centre; a straight facet has no centre.
    pub(super) fn spans(&self, outward: Vector2) -> bool {
        let Form::Round { radius, sense, from, to, extent, .. } = self.form else { return false };
        // By how much (m) the ray is behind the start and before the end.
        let [start, end] = self.beyond.map(|beyond| -beyond * outward.norm() / radius);
        let (after, before) = (sense * from.perp(&outward) >= start, sense * outward.perp(&to) >= end);
        match extent {
            Extent::UpToHalf => after && before,
            Extent::MoreThanHalf => after || before,
            Extent::Whole => true,
        }
    }

    /// Distance (m) of a point from the facet.
    pub(super) fn distance(&self, point: Point2) -> f64 {
        match (self.form, self.foot(point)) {
            (_, Some(foot)) => foot.height.abs(),
            // The centre is as far from everywhere.
            (Form::Round { centre, radius, .. }, None) if point == centre => radius,
            _ => self.ends.iter().map(|end| (point - end).norm()).fold(f64::INFINITY, f64::min),
        }
    }
}

impl Form {
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
    /// Whether it turns by more than 5°, as a polygon's corners do and hardly those of a curve that is drawn in pieces.
    pub(super) fn is_sharp(&self) -> bool {
        const COS_5_DEG: f64 = 0.9962;
        self.into.dot(&self.out) < COS_5_DEG
    }

    /// On which side of a line through the corner all is that is solid at it: +1 towards `left` of the line, −1 away from it; `None`
    /// if there is some on either side, or a side of the corner lies along the line.
    pub(super) fn side_of(&self, left: Vector2) -> Option<f64> {
        let (behind, before) = (-self.into.dot(&left), self.out.dot(&left));
        (behind * before > 0.0).then(|| before.signum())
    }

    /// The foot of a point whose nearest point of the outline is the corner.
    pub(super) fn foot(&self, point: Point2) -> Option<Foot> {
        let outward = point - self.point;
        let height = outward.norm();
        let faces = outward.dot(&self.into) > 0.0 && outward.dot(&self.out) < 0.0 && height > 0.0;
        faces.then(|| Foot { normal: outward / height, height, curvature: height.recip() })
    }
}

/// A facet in the tree.
#[derive(Debug)]
struct Leaf {
    index: usize,
    bounds: BoundingBox,
}

impl RTreeObject for Leaf {
    type Envelope = AABB<[f64; 2]>;

    fn envelope(&self) -> Self::Envelope {
        AABB::from_corners(self.bounds.min.into(), self.bounds.max.into())
    }
}
