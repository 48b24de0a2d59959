//! Contacts between features of a whisker and features of the surfaces.

use crate::geometry::{Point2, Vector2, perpendicular};

use super::friction::{Anchor, ConeForce};
use super::rod::{Rod, Shape};
use super::surface::{Junction, Surfaces};

/// A feature of a whisker and a feature of a surface that are near each other.
#[derive(Debug, Clone, Copy)]
pub(super) struct Pair {
    /// The index of the link. Either its far end or its side may touch.
    link: usize,
    features: FeaturePair,
    /// The contact force, 0 while the features do not touch.
    pub(super) force: ConeForce,
    /// The state from which the slip is measured, or `None` before the first contact is computed.
    pub(super) anchor: Option<Anchor>,
}

/// The kinds of feature pairs. Facets are given by their index, corners by the facet that precedes them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum FeaturePair {
    /// The far end of the link and a facet. The flag is true once the end has been outside of the facet. Before that,
    /// it is behind solid material and cannot touch the facet.
    EndOnFacet(usize, bool),
    /// The far end of the link and a convex corner.
    EndOnCorner(usize),
    /// The side of the link and a convex corner. The sign is +1 if the corner is to the left of the link, and −1 if it
    /// is to the right.
    SideOnCorner(usize, f64),
    /// The side of the link and a convex arc.
    SideOnBulge(usize),
}

/// A possible contact: its point on the whisker, its normal and its gap.
#[derive(Debug, Clone, Copy)]
pub(super) struct Contact {
    /// The index of its pair.
    pub(super) pair: usize,
    pub(super) link: usize,
    /// The position of the contact on the link (m from the near end).
    pub(super) along: f64,
    /// The direction of the force on the whisker, a unit vector in the world frame.
    pub(super) normal: Vector2,
    /// The distance between the surfaces (m), negative if they overlap.
    pub(super) gap: f64,
    pub(super) curvature: GapCurvature,
    /// The radius (m) of the whisker at the contact. Friction acts at this distance from the axis.
    pub(super) radius: f64,
    /// The distance (m) by which the whisker has slipped along the surface since it was anchored, positive to the left
    /// of the normal. Zero without friction.
    pub(super) slip: f64,
    /// The contact force of the previous step.
    pub(super) force: ConeForce,
}

/// The curvature of the gap for motion along the surface, without the curvature that link rotations cause.
#[derive(Debug, Clone, Copy)]
pub(super) enum GapCurvature {
    /// The gap is linear.
    None,
    /// The end of a link moves about a circle of this curvature (1/m). The curvature is negative on a concave arc.
    Circling(f64),
    /// The side of a link rolls on a point. The value is the distance (m) of the point from the axis of the link,
    /// positive to the right.
    Rolling(f64),
}

/// Returns the coordinates of a point in the frame of a link (m): along the link from its near end, and to its left.
pub(super) fn link_coordinates(shape: &Shape, link: usize, point: Point2) -> (f64, f64) {
    let from_start = point - shape.ends[link];
    (from_start.dot(&shape.tangents[link]), from_start.dot(&shape.left(link)))
}

impl FeaturePair {
    /// Identifies the features, whatever their state: their kind, and the index of the facet.
    fn key(self) -> (usize, u8) {
        match self {
            Self::EndOnFacet(facet, _) => (facet, 0),
            Self::EndOnCorner(facet) => (facet, 1),
            Self::SideOnCorner(facet, _) => (facet, 2),
            Self::SideOnBulge(facet) => (facet, 3),
        }
    }
}

impl Pair {
    pub(super) fn new(link: usize, features: FeaturePair) -> Self {
        Self { link, features, force: ConeForce::default(), anchor: None }
    }

    /// Identifies the link and the features, whatever their state.
    pub(super) fn key(&self) -> (usize, (usize, u8)) {
        (self.link, self.features.key())
    }

    /// Measures the slip of the pair from this configuration on, unless it sticks.
    pub(super) fn release_anchor(&mut self, rod: &Rod, shape: &Shape, surfaces: &Surfaces) {
        if self.force.sticks() {
            return;
        }
        self.anchor = None;
        if self.force.acts() {
            self.contact(rod, shape, surfaces, true);
        }
    }

    /// Returns the contact of the pair, or `None` if its features do not face each other.
    fn contact(&mut self, rod: &Rod, shape: &Shape, surfaces: &Surfaces, has_friction: bool) -> Option<Contact> {
        let link = self.link;
        let end = shape.ends[link + 1];
        let (force, anchor) = (self.force, &mut self.anchor);
        let angle = shape.world_angle(link);
        let slip = |anchor: &mut Option<Anchor>, now: Anchor, normal: Vector2, rolling: f64| {
            if has_friction {
                anchor.get_or_insert(now).slip(&now, perpendicular(normal), shape.tangents[link], rolling)
            } else {
                0.0
            }
        };
        let of_end = |anchor: &mut Option<Anchor>, projection: super::surface::Projection| Contact {
            pair: 0,
            link,
            along: rod.link,
            normal: projection.normal,
            gap: projection.height - rod.end_radius(link),
            curvature: if projection.curvature == 0.0 {
                GapCurvature::None
            } else {
                GapCurvature::Circling(projection.curvature)
            },
            radius: rod.end_radius(link),
            slip: slip(anchor, Anchor { place: end, along: rod.link, angle }, projection.normal, -rod.end_radius(link)),
            force,
        };
        // The side of the link touches a circle of `bulge` (m) about a point.
        let of_side =
            |anchor: &mut Option<Anchor>, place: Point2, (along, aside): (f64, f64), side: f64, bulge: f64| {
                let normal = -side * shape.left(link);
                Contact {
                    pair: 0,
                    link,
                    along,
                    normal,
                    gap: side * aside - (bulge + rod.radius(link)),
                    curvature: GapCurvature::Rolling(aside),
                    radius: rod.radius(link),
                    slip: slip(anchor, Anchor { place, along, angle }, normal, bulge),
                    force,
                }
            };
        match &mut self.features {
            FeaturePair::EndOnFacet(index, is_outside) => {
                let facet = surfaces.facet(*index);
                let projection = if *is_outside { facet.project_retained(end) } else { facet.project(end) };
                *is_outside = facet.is_outside(end) || (*is_outside && projection.is_some());
                projection.filter(|_| *is_outside).map(|projection| of_end(anchor, projection))
            }
            FeaturePair::EndOnCorner(index) => {
                let Junction::Convex(corner) = surfaces.facet(*index).junction else { return None };
                corner.project(end).map(|projection| of_end(anchor, projection))
            }
            FeaturePair::SideOnCorner(index, side) => {
                let Junction::Convex(corner) = surfaces.facet(*index).junction else { return None };
                let (along, aside) = link_coordinates(shape, link, corner.point);
                let is_beside = along > 0.0 && along < rod.link;
                // The sign changes only beyond the ends of the link, or after the end has moved from a facet over the
                // corner. In the second case all solid material is on the side of the corner, or the link points into it
                // and its end can be past the corner on this side alone.
                let (tangent, left) = (shape.tangents[link], shape.left(link));
                let is_known = |side: Option<f64>| side == Some(aside.signum());
                if !is_beside || is_known(corner.side_of(left)) || is_known(corner.side_past(tangent, left)) {
                    *side = aside.signum();
                }
                is_beside.then(|| of_side(anchor, corner.point, (along, aside), *side, 0.0))
            }
            FeaturePair::SideOnBulge(index) => {
                let facet = surfaces.facet(*index);
                let (centre, radius) = facet.bulge()?;
                let (along, aside) = link_coordinates(shape, link, centre);
                let side = aside.signum();
                let faces = along > 0.0 && along < rod.link && facet.spans(-side * shape.left(link));
                faces.then(|| of_side(anchor, centre, (along, aside), side, radius))
            }
        }
    }

    /// Returns the distance (m) between the end of the link and the sharp corner of this pair. `None` for other pairs.
    pub(super) fn sharp_corner(&self, shape: &Shape, surfaces: &Surfaces) -> Option<f64> {
        let FeaturePair::EndOnCorner(index) = self.features else { return None };
        let Junction::Convex(corner) = surfaces.facet(index).junction else { return None };
        corner.is_sharp().then(|| (shape.ends[self.link + 1] - corner.point).norm())
    }

    /// True if the pair belongs to the first link.
    pub(super) fn is_at_base(&self) -> bool {
        self.link == 0
    }

    /// The facet of an end-on-facet pair.
    fn facet(&self) -> Option<usize> {
        if let FeaturePair::EndOnFacet(index, _) = self.features { Some(index) } else { None }
    }
}

/// Narrow phase: computes the contacts of all pairs that face each other. The force of a pair that no longer does is
/// transferred to the contact that replaces it.
pub(super) fn narrow_phase(
    rod: &Rod,
    shape: &Shape,
    surfaces: &Surfaces,
    pairs: &mut [Pair],
    contacts: &mut Vec<Contact>,
    has_friction: bool,
) {
    contacts.clear();
    let mut orphaned = None;
    for (index, pair) in pairs.iter_mut().enumerate() {
        match pair.contact(rod, shape, surfaces, has_friction) {
            Some(contact) => contacts.push(Contact { pair: index, ..contact }),
            None if pair.force.acts() => {
                orphaned = Some((pair.link, std::mem::take(&mut pair.force)));
            }
            None => {}
        }
    }
    drop_hidden(surfaces, pairs, contacts);
    if let Some((link, force)) = orphaned
        && let Some(successor) = contacts
            .iter_mut()
            .filter(|contact| !contact.force.acts() && contact.link.abs_diff(link) <= 1)
            .min_by(|one, two| one.gap.total_cmp(&two.gap))
            .filter(|successor| successor.gap < TRANSFER_DISTANCE)
    {
        successor.force = force;
        pairs[successor.pair].force = force;
    }
}

/// The largest gap (m) of a contact that takes over the force of another pair.
const TRANSFER_DISTANCE: f64 = 1e-5;

/// Removes contacts that another facet hides.
///
/// Two facets may meet smoothly or at a convex corner. An end inside of both leaves by the facet with a force, or else
/// by the nearer one. An end outside of both is measured from the farther one.
fn drop_hidden(surfaces: &Surfaces, pairs: &[Pair], contacts: &mut Vec<Contact>) {
    let facet = |contact: &Contact| pairs[contact.pair].facet();
    let mut index = 0;
    while index < contacts.len() {
        let one = &contacts[index];
        let is_hidden = facet(one).is_some_and(|own| {
            contacts.iter().enumerate().any(|(at, two)| {
                let meet = |other: usize| {
                    let (behind, before) = (surfaces.facet(own), surfaces.facet(other));
                    (behind.next == other && behind.junction != Junction::Concave)
                        || (before.next == own && before.junction != Junction::Concave)
                };
                at != index
                    && one.link == two.link
                    && facet(two).is_some_and(|other| other != own && meet(other))
                    && (one.force.acts(), one.gap, index) < (two.force.acts(), two.gap, at)
            })
        });
        if is_hidden {
            contacts.remove(index);
        } else {
            index += 1;
        }
    }
}
