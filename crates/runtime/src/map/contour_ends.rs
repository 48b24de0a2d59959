//! The ends of contours: open ones, gaps, and those where the surface goes on.

use crate::geometry::{Point2, Vector2};
use crate::math;

use super::contours::{Contours, End, MOST_PIECES, Stored};

/// How a contour goes on at an end.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum EndKind {
    /// Nothing is known beyond it.
    Open,
    /// Another part of a contour is beyond it, after a gap.
    Gap {
        /// Where that part begins (m, world frame).
        to: Point2,
    },
    /// Another part of a contour goes on from it.
    Joined,
}

/// The piece and the end of a number of [`ContourEnds::ends`].
pub(super) fn piece_of(number: usize) -> (usize, End) {
    (number / 2, if number.is_multiple_of(2) { End::First } else { End::Last })
}

/// An end of a piece of contour.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContourEnd {
    /// Position (m, world frame).
    pub place: Point2,
    /// Unit vector (world frame) along the contour, out of the piece.
    pub outwards: Vector2,
    /// Unit normal (world frame) on the free side.
    pub normal: Vector2,
    /// Index in the policy of the whisker that recorded it.
    pub whisker: usize,
    /// How the contour goes on.
    pub kind: EndKind,
}

/// Standard deviations of two points within which their surface is the same, and the least distance (m) for exact points. It
/// is more than the distance of the stored points.
const SAME: f64 = 3.0;
pub(super) const CONTINUES: f64 = 6e-3;
/// Longest gap (m). Parts that are farther apart are open ends.
const LONGEST_GAP: f64 = 80e-3;
/// Cosine of the largest angle between the contour's direction at its end and the path across a gap.
const AHEAD: f64 = 0.5;
/// Cosine of the largest angle between the normals of points of one surface. The other side of a plate is another surface.
const ALIKE: f64 = -0.2;
/// Sine of the smallest angle between two surfaces that meet at a corner.
const CORNER: f64 = 0.35;
/// Length (m) of its own piece before an end that is not a part beyond it.
const OWN: f64 = 40e-3;

/// The kinds of all ends. One end is compared with all points in each tick, so the work of a tick is bounded.
#[derive(Debug, Clone)]
pub(super) struct ContourEnds {
    kinds: Vec<[EndKind; 2]>,
    next: usize,
}

impl ContourEnds {
    /// Creates memory for the ends of all pieces.
    pub(super) fn new() -> Self {
        Self { kinds: vec![[EndKind::Open; 2]; MOST_PIECES], next: 0 }
    }

    /// Compares the next end with all points.
    pub(super) fn update(&mut self, contours: &Contours) {
        let ends = 2 * contours.pieces().len();
        if ends == 0 {
            return;
        }
        self.next = (self.next + 1) % ends;
        let (piece, end) = piece_of(self.next);
        self.kinds[piece][end as usize] = kind(contours, piece, end);
    }

    /// All ends of pieces that have a direction.
    pub(super) fn ends<'a>(&'a self, contours: &'a Contours) -> impl Iterator<Item = (usize, ContourEnd)> + 'a {
        let pieces = contours.pieces().iter().enumerate().filter(|(_, piece)| piece.count > 1);
        pieces.flat_map(move |(index, piece)| {
            [End::First, End::Last].map(|end| {
                let Stored { place, normal, .. } = piece.ends[end as usize];
                let found = ContourEnd {
                    place,
                    outwards: piece.outwards[end as usize],
                    normal: Vector2::new(f64::from(normal[0]), f64::from(normal[1])),
                    whisker: usize::from(piece.whisker),
                    kind: self.kinds[index][end as usize],
                };
                (2 * index + end as usize, found)
            })
        })
    }
}

/// How the contour goes on at an end of a piece.
fn kind(contours: &Contours, index: usize, end: End) -> EndKind {
    let piece = &contours.pieces()[index];
    let (at, outwards) = (piece.ends[end as usize], piece.outwards[end as usize]);
    let own = (OWN / contours.spacing()).ceil();
    let mut nearest: Option<(f64, Point2, bool)> = None;
    let mut number = 0.0;
    for point in contours.points() {
        if usize::from(point.piece) == index {
            number += 1.0;
            let from_end = if end == End::First { number - 1.0 } else { f64::from(piece.count) - number };
            if from_end <= own {
                continue;
            }
        }
        let way = point.place - at.place;
        let distance = way.norm();
        let same =
            math::max(SAME * f64::from(at.deviation + point.deviation), math::max(CONTINUES, 2.0 * contours.spacing()));
        let alike = f64::from(at.normal[0] * point.normal[0] + at.normal[1] * point.normal[1]);
        let is_same = distance < same && alike > ALIKE;
        let is_ahead = distance < LONGEST_GAP && way.dot(&outwards) > AHEAD * distance;
        if (is_same || is_ahead) && nearest.is_none_or(|(least, ..)| distance < least) {
            nearest = Some((distance, point.place, is_same));
        }
    }
    if is_at_corner(contours, at, outwards) {
        return EndKind::Joined;
    }
    match nearest {
        None => EndKind::Open,
        Some((.., true)) => EndKind::Joined,
        Some((_, to, false)) => EndKind::Gap { to },
    }
}

/// True if an end is at a corner to which another piece leads. What that piece lacks up to the corner is its own gap.
fn is_at_corner(contours: &Contours, at: Stored, outwards: Vector2) -> bool {
    let normal_of = |stored: &Stored| Vector2::new(f64::from(stored.normal[0]), f64::from(stored.normal[1]));
    contours.pieces().iter().filter(|piece| piece.count > 1).any(|piece| {
        piece.ends.iter().zip(piece.outwards).any(|(other, others)| {
            let sine = outwards.perp(&others);
            if sine.abs() < CORNER {
                return false;
            }
            // The lines of both meet at these distances from the two ends.
            let way = other.place - at.place;
            let (distance, from_other) = (way.perp(&others) / sine, way.perp(&outwards) / sine);
            let is_outer = normal_of(&at).dot(&others) > 0.0;
            distance.abs() < CONTINUES
                && from_other > -CONTINUES
                && from_other < LONGEST_GAP
                && is_outer == (normal_of(other).dot(&outwards) > 0.0)
        })
    })
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_2;

    use proptest::prelude::*;

    use super::*;
    use crate::geometry::unit;

    /// Records an arc of a circle about the origin, from one angle to another one, felt from outside.
    fn arc(contours: &mut Contours, radius: f64, from: f64, to: f64) {
        let steps = 2000;
        for step in 0..=steps {
            let direction = unit(from + (to - from) * f64::from(step) / f64::from(steps));
            contours.record(0, Point2::from(radius * direction), 1e-4, Point2::from(1.5 * radius * direction));
        }
        for _ in 0..20 {
            contours.skip(0);
        }
    }

    fn kinds(contours: &Contours) -> Vec<EndKind> {
        let mut ends = ContourEnds::new();
        for _ in 0..=2 * contours.pieces().len() {
            ends.update(contours);
        }
        ends.ends(contours).map(|(_, end)| end.kind).collect()
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(40))]

        #[test]
        fn an_arc_has_two_open_ends_a_gap_or_none(radius in 0.05..0.3_f64, start in -3.0..3.0_f64, gap in 1e-3..0.3_f64) {
            let mut contours = Contours::new(1);
            arc(&mut contours, radius, start, start + std::f64::consts::TAU - gap / radius);
            let found = kinds(&contours);
            prop_assert_eq!(found.len(), 2);
            let chord = 2.0 * radius * math::sin(0.5 * gap / radius);
            for kind in found {
                if chord < 4e-3 {
                    prop_assert_eq!(kind, EndKind::Joined);
                } else if chord > 10e-3 && chord < 70e-3 && gap < radius {
                    let EndKind::Gap { to } = kind else { panic!("{kind:?} for {chord} m") };
                    prop_assert!((to.coords.norm() - radius).abs() < 1e-3);
                } else if chord > 85e-3 {
                    prop_assert_eq!(kind, EndKind::Open);
                }
            }
        }

        #[test]
        fn two_pieces_join_where_they_meet(radius in 0.05..0.3_f64, split in 0.5..2.5_f64) {
            let mut contours = Contours::new(1);
            arc(&mut contours, radius, 0.0, split);
            arc(&mut contours, radius, split + 0.003 / radius, 3.0);
            let found = kinds(&contours);
            prop_assert_eq!(found.iter().filter(|kind| **kind == EndKind::Joined).count(), 2);
        }
    }

    /// Records a straight piece between two positions, felt from a side.
    fn straight(contours: &mut Contours, from: Point2, to: Point2, side: Vector2) {
        for step in 0..=400 {
            let place = from + f64::from(step) / 400.0 * (to - from);
            contours.record(0, place, 1e-4, place + 0.05 * side);
        }
        for _ in 0..20 {
            contours.skip(0);
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(60))]

        /// The corner is the origin. The first piece ends near it, and the second one begins behind it.
        #[test]
        fn an_end_at_a_corner_is_joined_with_the_piece_behind_it(
            turn in 0.5..2.5_f64, is_outer: bool, before in 0.0..5e-3_f64, behind in 9e-3..60e-3_f64,
        ) {
            let mut contours = Contours::new(1);
            let (way, normal) = (unit(0.0), unit(FRAC_PI_2));
            // An outer corner turns away from the free side.
            let angle = if is_outer { -turn } else { turn };
            straight(&mut contours, Point2::from(-0.3 * way), Point2::from(-before * way), normal);
            straight(&mut contours, Point2::from(behind * unit(angle)), Point2::from(0.3 * unit(angle)), unit(angle + FRAC_PI_2));
            let found = kinds(&contours);
            prop_assert_eq!(found[1], EndKind::Joined);
            prop_assert!(found[2] != EndKind::Joined, "what the second piece lacks has to be traced");
            prop_assert!(found[0] == EndKind::Open && found[3] == EndKind::Open);
        }

        /// Two pieces whose lines meet, but of which one faces the other direction, are not one surface.
        #[test]
        fn a_piece_that_faces_the_other_way_joins_no_corner(turn in 0.5..2.5_f64, behind in 9e-3..60e-3_f64) {
            let mut contours = Contours::new(1);
            straight(&mut contours, Point2::new(-0.3, 0.0), Point2::new(-2e-3, 0.0), unit(FRAC_PI_2));
            straight(&mut contours, Point2::from(behind * unit(-turn)), Point2::from(0.3 * unit(-turn)), -unit(-turn + FRAC_PI_2));
            prop_assert!(kinds(&contours)[1] != EndKind::Joined);
        }
    }

    #[test]
    fn the_other_side_of_a_thin_plate_is_not_the_same_surface() {
        let mut contours = Contours::new(1);
        for (y, from) in [(1e-3, 0.2), (-1e-3, -0.2)] {
            for step in 0..50 {
                contours.record(0, Point2::new(2e-3 * f64::from(step), y), 1e-4, Point2::new(0.05, from));
            }
            for _ in 0..20 {
                contours.skip(0);
            }
        }
        assert!(kinds(&contours).iter().all(|kind| *kind != EndKind::Joined));
    }
}
