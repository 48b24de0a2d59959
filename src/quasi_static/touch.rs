//! What of a whisker may touch what of a surface.

use crate::geometry::{Point2, Vector2};

use super::surface::{Joint, Surfaces};
use super::wire::{Shape, Wire};

/// A part of a whisker and a part of a surface that are near each other.
#[derive(Debug, Clone, Copy)]
pub(super) struct Pair {
    /// The link, of which either the far end may touch or the side.
    link: usize,
    part: Part,
    /// The force (N) between them, 0 while they do not touch.
    pub(super) force: f64,
}

/// What may touch what.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Part {
    /// The far end of the link and the facet with this index; and whether the end was outside of it when it came beside it, or has been
    /// since. If not, it is behind what is solid.
    EndOnFacet(usize, bool),
    /// The far end of the link and the corner behind a facet.
    EndOnCorner(usize),
    /// The side of the link and the corner behind a facet; which is on the link's left (+1) or right (−1).
    SideOnCorner(usize, f64),
    /// The side of the link and a facet that bulges.
    SideOnBulge(usize),
}

/// Where a pair would touch, and how far it is from that.
#[derive(Debug, Clone, Copy)]
pub(super) struct Contact {
    /// Which of the pairs.
    pub(super) pair: usize,
    pub(super) link: usize,
    /// Where on the link (m from its near end).
    pub(super) along: f64,
    /// Direction of the force on the whisker, a unit vector.
    pub(super) normal: Vector2,
    /// Distance between the two (m); negative where they overlap.
    pub(super) gap: f64,
    pub(super) curving: Curving,
    /// The force (N) that was there last.
    pub(super) force: f64,
}

/// How the gap curves while the whisker moves along the surface, beyond what its links' turning makes.
#[derive(Debug, Clone, Copy)]
pub(super) enum Curving {
    /// Not at all.
    None,
    /// As the distance from a circle about which the end of a link goes, with this curvature (1/m); negative in a hollow.
    Circling(f64),
    /// As the distance of a link's side from a point, which is this far (m) off the link's axis, on its right if positive.
    Rolling(f64),
}

/// Pairs nearer than this (m) are watched one by one.
const WATCHED: f64 = 5e-3;
/// How far (m) from the whisker facets are looked for.
const LOOKED_FOR: f64 = 20e-3;

/// Finds all pairs that are near each other, keeps what is known of those that were `pairs` already, and gives a distance (m) that
/// all others are apart.
pub(super) fn survey(wire: &Wire, shape: &Shape, surfaces: &Surfaces, pairs: &mut Vec<Pair>) -> f64 {
    let known = pairs.clone();
    pairs.clear();
    let mut clear = LOOKED_FOR;
    let mut take = |link: usize, part: Part, distance: f64| {
        if distance < WATCHED {
            let same = |pair: &&Pair| pair.link == link && pair.part.is_same(part);
            pairs.push(known.iter().find(same).copied().unwrap_or(Pair { link, part, force: 0.0 }));
        } else {
            clear = clear.min(distance);
        }
    };
    for (index, facet) in surfaces.near(shape.bounds(), LOOKED_FOR) {
        for link in 0..wire.links() {
            let (start, end) = (shape.ends[link], shape.ends[link + 1]);
            let rest = facet.distance(nalgebra::center(&start, &end)) - 0.5 * wire.link - wire.radius(link);
            if rest > WATCHED {
                take(link, Part::EndOnFacet(index, false), rest);
                continue;
            }
            let radius = wire.end_radius(link);
            take(link, Part::EndOnFacet(index, facet.is_outside(end)), facet.distance(end) - radius);
            if let Joint::Convex(corner) = facet.joint {
                take(link, Part::EndOnCorner(index), (end - corner.point).norm() - radius);
                let (along, aside) = beside(shape, link, corner.point);
                let nearest = start + along.clamp(0.0, wire.link) * shape.along[link];
                let distance = (corner.point - nearest).norm() - wire.radius(link);
                take(link, Part::SideOnCorner(index, aside.signum()), distance);
            }
            if let Some((centre, bulge)) = facet.bulge() {
                let (along, _) = beside(shape, link, centre);
                let nearest = start + along.clamp(0.0, wire.link) * shape.along[link];
                let gap = (centre - nearest).norm() - bulge - wire.radius(link);
                take(link, Part::SideOnBulge(index), gap.abs());
            }
        }
    }
    clear
}

/// Where a point is beside a link: how far along it from its near end, and how far to its left (m).
fn beside(shape: &Shape, link: usize, point: Point2) -> (f64, f64) {
    let from_start = point - shape.ends[link];
    (from_start.dot(&shape.along[link]), from_start.dot(&shape.left(link)))
}

impl Part {
    fn is_same(self, other: Self) -> bool {
        match (self, other) {
            (Self::SideOnCorner(one, _), Self::SideOnCorner(two, _))
            | (Self::EndOnFacet(one, _), Self::EndOnFacet(two, _)) => one == two,
            _ => self == other,
        }
    }
}

impl Pair {
    /// Where the two would touch; `None` if they do not face each other.
    fn contact(&mut self, wire: &Wire, shape: &Shape, surfaces: &Surfaces) -> Option<Contact> {
        let link = self.link;
        let end = shape.ends[link + 1];
        let of_end = |foot: super::surface::Foot| Contact {
            pair: 0,
            link,
            along: wire.link,
            normal: foot.normal,
            gap: foot.height - wire.end_radius(link),
            curving: if foot.curvature == 0.0 { Curving::None } else { Curving::Circling(foot.curvature) },
            force: self.force,
        };
        let of_side = |along: f64, point_aside: f64, side: f64, apart: f64| Contact {
            pair: 0,
            link,
            along,
            normal: -side * shape.left(link),
            gap: side * point_aside - apart,
            curving: Curving::Rolling(point_aside),
            force: self.force,
        };
        match &mut self.part {
            Part::EndOnFacet(index, is_outside) => {
                let facet = surfaces.facet(*index);
                let foot = if *is_outside { facet.foot_of_known(end) } else { facet.foot(end) };
                *is_outside = facet.is_outside(end) || (*is_outside && foot.is_some());
                foot.filter(|_| *is_outside).map(of_end)
            }
            Part::EndOnCorner(index) => {
                let Joint::Convex(corner) = surfaces.facet(*index).joint else { return None };
                corner.foot(end).map(of_end)
            }
            Part::SideOnCorner(index, side) => {
                let Joint::Convex(corner) = surfaces.facet(*index).joint else { return None };
                let (along, aside) = beside(shape, link, corner.point);
                let is_beside = along > 0.0 && along < wire.link;
                // It changes sides beyond the link's ends, or where the end came off a facet over the corner: then all that is solid is
                // on the side on which the corner is.
                if !is_beside || corner.side_of(shape.left(link)) == Some(aside.signum()) {
                    *side = aside.signum();
                }
                is_beside.then(|| of_side(along, aside, *side, wire.radius(link)))
            }
            Part::SideOnBulge(index) => {
                let facet = surfaces.facet(*index);
                let (centre, radius) = facet.bulge()?;
                let (along, aside) = beside(shape, link, centre);
                let side = aside.signum();
                let faces = along > 0.0 && along < wire.link && facet.spans(-side * shape.left(link));
                faces.then(|| of_side(along, aside, side, radius + wire.radius(link)))
            }
        }
    }

    /// How far (m) an end is from the sharp corner that it may touch.
    pub(super) fn sharp_corner(&self, shape: &Shape, surfaces: &Surfaces) -> Option<f64> {
        let Part::EndOnCorner(index) = self.part else { return None };
        let Joint::Convex(corner) = surfaces.facet(index).joint else { return None };
        corner.is_sharp().then(|| (shape.ends[self.link + 1] - corner.point).norm())
    }

    /// Whether it is one of the first link.
    pub(super) fn is_at_base(&self) -> bool {
        self.link == 0
    }

    /// The facet that an end may touch.
    fn facet(&self) -> Option<usize> {
        if let Part::EndOnFacet(index, _) = self.part { Some(index) } else { None }
    }
}

/// All pairs that face each other, as contacts. Forces of pairs that do so no longer go over to what is in their place.
pub(super) fn contacts(
    wire: &Wire,
    shape: &Shape,
    surfaces: &Surfaces,
    pairs: &mut [Pair],
    contacts: &mut Vec<Contact>,
) {
    contacts.clear();
    let mut left_over = None;
    for (index, pair) in pairs.iter_mut().enumerate() {
        match pair.contact(wire, shape, surfaces) {
            Some(contact) => contacts.push(Contact { pair: index, ..contact }),
            None if pair.force > 0.0 => {
                left_over = Some((pair.link, std::mem::take(&mut pair.force)));
            }
            None => {}
        }
    }
    drop_hidden(surfaces, pairs, contacts);
    if let Some((link, force)) = left_over
        && let Some(heir) = contacts
            .iter_mut()
            .filter(|contact| contact.force == 0.0 && contact.link.abs_diff(link) <= 1)
            .min_by(|one, two| one.gap.total_cmp(&two.gap))
            .filter(|heir| heir.gap < HEIR)
    {
        heir.force = force;
        pairs[heir.pair].force = force;
    }
}

/// A pair this near (m) takes over the force of one that faces each other no longer.
const HEIR: f64 = 1e-5;

/// Of two facets that meet smoothly or in a corner that sticks out, an end inside of both is to leave by the one on which it bears, or
/// by the nearer; and one that is inside of none is outside of the farther.
fn drop_hidden(surfaces: &Surfaces, pairs: &[Pair], contacts: &mut Vec<Contact>) {
    let facet = |contact: &Contact| pairs[contact.pair].facet();
    let mut index = 0;
    while index < contacts.len() {
        let one = &contacts[index];
        let is_hidden = facet(one).is_some_and(|own| {
            contacts.iter().enumerate().any(|(at, two)| {
                let meet = |other: usize| {
                    let (behind, before) = (surfaces.facet(own), surfaces.facet(other));
                    (behind.next == other && behind.joint != Joint::Concave)
                        || (before.next == own && before.joint != Joint::Concave)
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
