//! Contacts between features of a whisker and features of the surfaces.

use crate::geometry::{Point2, Vector2};

use super::rod::{Rod, Shape};
use super::surface::{Junction, Surfaces};

/// A feature of a whisker and a feature of a surface that are near each other.
#[derive(Debug, Clone, Copy)]
pub(super) struct Pair {
    /// The index of the link. Either its far end or its side may touch.
    link: usize,
    features: FeaturePair,
    /// The contact force (N), 0 while the features do not touch.
    pub(super) force: f64,
}

/// The kinds of feature pairs. Facets are given by their index, corners by the facet that precedes them.
#[derive(Debug, Clone, Copy, PartialEq)]
enum FeaturePair {
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
    /// The contact force of the previous step (N).
    pub(super) force: f64,
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

/// Feature pairs closer than this (m) are tracked individually.
const PAIR_DISTANCE: f64 = 5e-3;
/// The distance (m) around the whisker within which facets are searched.
const SEARCH_MARGIN: f64 = 20e-3;

/// Broad phase: finds all feature pairs that are near each other. The state of pairs that were already in `pairs` is
/// kept. Returns a lower bound (m) of the distance of all other pairs.
pub(super) fn broad_phase(rod: &Rod, shape: &Shape, surfaces: &Surfaces, pairs: &mut Vec<Pair>) -> f64 {
    let previous = pairs.clone();
    pairs.clear();
    let mut clear = SEARCH_MARGIN;
    let mut add = |link: usize, features: FeaturePair, distance: f64| {
        if distance < PAIR_DISTANCE {
            let same = |pair: &&Pair| pair.link == link && pair.features.is_same(features);
            pairs.push(previous.iter().find(same).copied().unwrap_or(Pair { link, features, force: 0.0 }));
        } else {
            clear = clear.min(distance);
        }
    };
    for (index, facet) in surfaces.near(shape.bounds(), SEARCH_MARGIN) {
        for link in 0..rod.links() {
            let (start, end) = (shape.ends[link], shape.ends[link + 1]);
            let rest = facet.distance(nalgebra::center(&start, &end)) - 0.5 * rod.link - rod.radius(link);
            if rest > PAIR_DISTANCE {
                add(link, FeaturePair::EndOnFacet(index, false), rest);
                continue;
            }
            let radius = rod.end_radius(link);
            add(link, FeaturePair::EndOnFacet(index, facet.is_outside(end)), facet.distance(end) - radius);
            if let Junction::Convex(corner) = facet.junction {
                add(link, FeaturePair::EndOnCorner(index), (end - corner.point).norm() - radius);
                let (along, aside) = link_coordinates(shape, link, corner.point);
                let nearest = start + along.clamp(0.0, rod.link) * shape.tangents[link];
                let distance = (corner.point - nearest).norm() - rod.radius(link);
                add(link, FeaturePair::SideOnCorner(index, aside.signum()), distance);
            }
            if let Some((centre, bulge)) = facet.bulge() {
                let (along, _) = link_coordinates(shape, link, centre);
                let nearest = start + along.clamp(0.0, rod.link) * shape.tangents[link];
                let gap = (centre - nearest).norm() - bulge - rod.radius(link);
                add(link, FeaturePair::SideOnBulge(index), gap.abs());
            }
        }
    }
    clear
}

/// Returns the coordinates of a point in the frame of a link (m): along the link from its near end, and to its left.
fn link_coordinates(shape: &Shape, link: usize, point: Point2) -> (f64, f64) {
    let from_start = point - shape.ends[link];
    (from_start.dot(&shape.tangents[link]), from_start.dot(&shape.left(link)))
}

impl FeaturePair {
    fn is_same(self, other: Self) -> bool {
        match (self, other) {
            (Self::SideOnCorner(one, _), Self::SideOnCorner(two, _))
            | (Self::EndOnFacet(one, _), Self::EndOnFacet(two, _)) => one == two,
            _ => self == other,
        }
    }
}

impl Pair {
    /// Returns the contact of the pair, or `None` if its features do not face each other.
    fn contact(&mut self, rod: &Rod, shape: &Shape, surfaces: &Surfaces) -> Option<Contact> {
        let link = self.link;
        let end = shape.ends[link + 1];
        let of_end = |projection: super::surface::Projection| Contact {
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
            force: self.force,
        };
        let of_side = |along: f64, point_aside: f64, side: f64, offset: f64| Contact {
            pair: 0,
            link,
            along,
            normal: -side * shape.left(link),
            gap: side * point_aside - offset,
            curvature: GapCurvature::Rolling(point_aside),
            force: self.force,
        };
        match &mut self.features {
            FeaturePair::EndOnFacet(index, is_outside) => {
                let facet = surfaces.facet(*index);
                let projection = if *is_outside { facet.project_retained(end) } else { facet.project(end) };
                *is_outside = facet.is_outside(end) || (*is_outside && projection.is_some());
                projection.filter(|_| *is_outside).map(of_end)
            }
            FeaturePair::EndOnCorner(index) => {
                let Junction::Convex(corner) = surfaces.facet(*index).junction else { return None };
                corner.project(end).map(of_end)
            }
            FeaturePair::SideOnCorner(index, side) => {
                let Junction::Convex(corner) = surfaces.facet(*index).junction else { return None };
                let (along, aside) = link_coordinates(shape, link, corner.point);
                let is_beside = along > 0.0 && along < rod.link;
                // The sign changes only beyond the ends of the link, or after the end has moved from a facet over the
                // corner. In the second case all solid material is on the side of the corner.
                if !is_beside || corner.side_of(shape.left(link)) == Some(aside.signum()) {
                    *side = aside.signum();
                }
                is_beside.then(|| of_side(along, aside, *side, rod.radius(link)))
            }
            FeaturePair::SideOnBulge(index) => {
                let facet = surfaces.facet(*index);
                let (centre, radius) = facet.bulge()?;
                let (along, aside) = link_coordinates(shape, link, centre);
                let side = aside.signum();
                let faces = along > 0.0 && along < rod.link && facet.spans(-side * shape.left(link));
                faces.then(|| of_side(along, aside, side, radius + rod.radius(link)))
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
) {
    contacts.clear();
    let mut orphaned = None;
    for (index, pair) in pairs.iter_mut().enumerate() {
        match pair.contact(rod, shape, surfaces) {
            Some(contact) => contacts.push(Contact { pair: index, ..contact }),
            None if pair.force > 0.0 => {
                orphaned = Some((pair.link, std::mem::take(&mut pair.force)));
            }
            None => {}
        }
    }
    drop_hidden(surfaces, pairs, contacts);
    if let Some((link, force)) = orphaned
        && let Some(successor) = contacts
            .iter_mut()
            .filter(|contact| contact.force == 0.0 && contact.link.abs_diff(link) <= 1)
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
                    && (one.force > 0.0, one.gap, index) < (two.force > 0.0, two.gap, at)
            })
        });
        if is_hidden {
            contacts.remove(index);
        } else {
            index += 1;
        }
    }
}
